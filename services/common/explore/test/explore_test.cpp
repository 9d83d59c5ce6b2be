#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>

#include "drive/building.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/maps/route.hpp"
#include "saphira/maps/topology.hpp"

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
  const test::MapScore score = test::score(built.aligned_map(), reference);
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

INSTANTIATE_TEST_SUITE_P(Worlds, Explore,
                         ::testing::Values(Case{"loop", 1, 1.0, true}, Case{"loop", 2, 1.0, true},
                                           Case{"office-floor", 1, 1.0, true},
                                           Case{"office-floor", 2, 1.0, true}));

// The east corridor is walled off in its middle: a dead end from the south and one from the north.
TEST(Explore, AClosedWayIsADeadEndFromBothSides) {
  const std::string file = ::testing::TempDir() + "closed-loop.wld";
  std::ofstream(file) << read_file(config_folder() + "/worlds/loop.wld")
                      << "\n23000 9000 25000 9000\n";
  DriveOptions options;
  options.world = file;
  Building built(options);
  built.run(20000);
  built.draw("closed-loop");
  EXPECT_TRUE(built.explorer.output().done) << built.explorer.output().reason;
  std::vector<maps::Feature> east;
  for (const maps::Feature& f : built.builder.map().features)
    if (f.type == lps::PointType::corridor && std::abs(f.pose_in_map.x - 24.0) < 0.3)
      east.push_back(f);
  ASSERT_EQ(east.size(), 2U) << maps::to_text(built.builder.map());
  for (const maps::Feature& f : east)
    EXPECT_NEAR(f.length, 8.0, 0.25);
  EXPECT_EQ(built.drive.contacts(), 0);
}

// The robot finds its way by what it has built: from wherever it is to a door at the other end.
TEST(Explore, TheRobotNavigatesByTheMapThatItBuilt) {
  DriveOptions options;
  options.world = "loop";
  Building built(options);
  built.run(20000);
  const maps::Topology topology(built.builder.map());
  const auto door = std::find_if(
      topology.links().begin(), topology.links().end(),
      [](const auto& l) { return (l.pose_in_map.position() - Vec2(11.95, 15.0)).norm() < 0.5; });
  ASSERT_NE(door, topology.links().end()) << "L7's";
  const auto [route, reason] =
      maps::find_route(topology, built.builder.pose_in_map().position(), std::to_string(door->id));
  ASSERT_TRUE(route) << reason;
  for (const Vec2& point : route->points())
    ASSERT_TRUE(built.drive_to(point, 1500)) << point.transpose();
  EXPECT_LT((built.true_way.back() - Vec2(11.95, 15.6)).norm(), 0.7);
  EXPECT_EQ(built.drive.contacts(), 0);
}

}  // namespace
}  // namespace saphira::explore
