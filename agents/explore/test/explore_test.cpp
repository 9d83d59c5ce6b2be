#include <gtest/gtest.h>

#include <iostream>

#include "building.hpp"
#include "saphira/base/places.hpp"

namespace saphira::explore {
namespace {

using test::Building;
using test::DriveOptions;

struct Case {
  std::string world;
  std::uint64_t seed;
  double errors;
  bool snap;
};

class Explore : public ::testing::TestWithParam<Case> {};

TEST_P(Explore, BuildsTheMapOfAFloorFromNothing) {
  DriveOptions options;
  options.world = GetParam().world;
  options.seed = GetParam().seed;
  options.errors = GetParam().errors;
  registration::MapBuilderSettings building;
  building.snap_to_right_angle_grid = GetParam().snap;
  Building built(options, building);
  built.run(20000);
  const std::string name = options.world + "-" + std::to_string(options.seed);
  built.draw(name);
  const maps::Map reference = maps::load_map(config_folder() + "/maps/" + options.world + ".map");
  const test::MapScore score = test::score(built.builder.map(), reference);
  std::cout << name << ": " << built.drive.seen().cycle << " cycles, corridors "
            << score.corridors_found << "/" << score.corridors << ", lengths to "
            << 100.0 * score.worst_length << " %, doors " << score.doors_found << "/" << score.doors
            << ", false " << score.corridors_false << "+" << score.doors_false << ", contacts "
            << built.drive.contacts() << ", closures " << built.builder.closures() << ", pose to "
            << built.worst << " m;" << score.text << "\n";
  EXPECT_TRUE(built.explorer.output().done) << built.explorer.output().reason;
  EXPECT_EQ(score.corridors_found, score.corridors) << score.text;
  EXPECT_EQ(score.corridors_false, 0) << score.text;
  EXPECT_GE(score.doors_found, 0.9 * score.doors) << score.text;
  EXPECT_EQ(score.doors_false, 0) << score.text;
  EXPECT_GT(built.builder.closures(), 0) << "the loop was not closed";
  EXPECT_EQ(built.drive.contacts(), 0);
}

INSTANTIATE_TEST_SUITE_P(
    Worlds, Explore,
    ::testing::Values(Case{"loop", 1, 1.0, true}, Case{"loop", 2, 1.0, true},
                      Case{"loop", 3, 2.0, true}, Case{"loop", 1, 1.0, false},
                      Case{"office-floor", 1, 1.0, true}, Case{"office-floor", 2, 1.0, true},
                      Case{"office-floor", 3, 2.0, true}, Case{"office-floor", 3, 1.0, true},
                      Case{"office-floor", 4, 1.0, true}, Case{"office-floor", 5, 1.0, true},
                      Case{"office-floor", 6, 1.0, true}, Case{"loop", 4, 1.0, true},
                      Case{"loop", 5, 1.0, true}, Case{"loop", 6, 1.0, true}));

}  // namespace
}  // namespace saphira::explore
