#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>

#include "drive/building.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/explore/explorer.hpp"
#include "saphira/explore/free_floor.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::explore {
namespace {

using test::Building;
using test::DriveOptions;

struct Case {
  std::string world;
  std::uint64_t seed;
};

class Explore : public ::testing::TestWithParam<Case> {};

TEST_P(Explore, BuildsTheMapOfAFloorFromNothing) {
  DriveOptions options{.world = GetParam().world, .seed = GetParam().seed};
  Building built(options);
  built.run(20000);
  const std::string name = options.world + "-" + std::to_string(options.seed);
  built.draw(name);
  const maps::Map reference = maps::load_map(config_folder() + "/maps/" + options.world + ".map");
  const test::MapScore score = test::score(built.aligned_map(), reference);
  std::cout << name << ": " << built.whole.drive().seen().cycle << " cycles, corridors "
            << score.corridors_found << "/" << score.corridors << ", lengths to "
            << 100.0 * score.worst_length << " %, doors " << score.doors_found << "/" << score.doors
            << ", false " << score.corridors_false << "+" << score.doors_false << ", contacts "
            << built.whole.drive().contacts() << ", closures " << built.closures << ", pose to "
            << built.worst << " m;" << score.text << "\n";
  EXPECT_TRUE(built.done()) << built.reason();
  EXPECT_EQ(score.corridors_found, score.corridors) << score.text;
  EXPECT_EQ(score.corridors_false, 0) << score.text;
  EXPECT_GE(score.doors_found, 0.9 * score.doors) << score.text;
  EXPECT_EQ(score.doors_false, 0) << score.text;
  EXPECT_GT(built.closures, 0) << "the loop was not closed";
  EXPECT_EQ(built.whole.drive().contacts(), 0);
}

INSTANTIATE_TEST_SUITE_P(Worlds, Explore,
                         ::testing::Values(Case{"loop", 1}, Case{"loop", 2},
                                           Case{"office-floor", 1}, Case{"office-floor", 2}));

// The east corridor is walled off in its middle: a dead end from the south and one from the north.
TEST(Explore, AClosedWayIsADeadEndFromBothSides) {
  const std::string file = ::testing::TempDir() + "closed-loop.wld";
  std::ofstream(file) << read_file(config_folder() + "/worlds/loop.wld")
                      << "\n23000 9000 25000 9000\n";
  Building built({.world = file});
  built.run(20000);
  built.draw("closed-loop");
  EXPECT_TRUE(built.done()) << built.reason();
  std::vector<maps::Feature> east;
  for (const maps::Feature& f : built.whole.map().features)
    if (f.type == lps::PointType::corridor && std::abs(f.pose_in_map.x - 24.0) < 0.3)
      east.push_back(f);
  ASSERT_EQ(east.size(), 2U) << maps::to_text(built.whole.map());
  for (const maps::Feature& f : east)
    EXPECT_NEAR(f.length, 8.0, 0.25);
  EXPECT_EQ(built.whole.drive().contacts(), 0);
}

// Two of the doors are beside the ends of the hall, with a wall on one side only: they are known
// since the robot drove through. It hears them from beside, before one of their posts.
class HallEnds : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(HallEnds, DoorsBesideThemAreOnTheMap) {
  Building built({.world = "small-office", .seed = GetParam()});
  built.run(20000);
  EXPECT_TRUE(built.done()) << built.reason();
  const test::MapScore score =
      test::score(built.aligned_map(), maps::load_map(config_folder() + "/maps/small-office.map"));
  EXPECT_EQ(score.doors, 4) << score.text;
  EXPECT_EQ(score.doors_found, 4) << score.text;
  EXPECT_EQ(score.doors_false, 0) << score.text;
  EXPECT_EQ(score.corridors_found, 1) << score.text;
  EXPECT_EQ(built.whole.drive().contacts(), 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, HallEnds, ::testing::Values(1, 2, 5, 6));

// A cupboard stands in the hall: the guard must not hold the robot there for good. Where it does,
// the map is not called whole.
TEST(Explore, TheGuardLetsTheRobotPassACupboard) {
  const maps::Map reference = maps::load_map(config_folder() + "/maps/small-office.map");
  int whole = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    DriveOptions options;
    options.world = "small-office";
    options.seed = seed;
    options.guard = true;
    Building built(options);
    built.run(20000);
    const test::MapScore score = test::score(built.aligned_map(), reference);
    EXPECT_EQ(built.done(), score.doors_found == 4) << seed << ": " << built.reason();
    EXPECT_EQ(score.doors_false, 0) << seed;
    EXPECT_EQ(built.whole.drive().contacts(), 0) << seed;
    whole += built.done() ? 1 : 0;
  }
  EXPECT_GE(whole, 6) << "of 8";
}

// No wall is heard, and the robot does not move.
TEST(Explorer, AWayThatItCannotFollowIsLeft) {
  Explorer explorer(Settings{});
  const maps::Map map;
  const std::vector<Vec2> way{{0.0, 0.0}};
  const std::vector<lps::SonarReading> silent;
  for (std::uint64_t cycle = 1; cycle < 20000 && !explorer.output().done; ++cycle)
    explorer.step({cycle, {}, map, way, silent});
  EXPECT_TRUE(explorer.output().done);
  EXPECT_EQ(explorer.left(map), std::vector<std::string>{"straight on (closed)"});
}

/// A robot that goes where the explorer wants along the x axis. stays: but not the way back.
/// Returns Explorer::left().
std::vector<std::string> left_after_a_corridor(bool stays) {
  Settings settings;
  settings.sonars = {{0, {0.2, 0.0, 0.0}}, {1, {0.0, 0.2, kPi / 2}}, {2, {0.0, -0.2, -kPi / 2}}};
  Explorer explorer(settings);
  const maps::Map map = maps::parse_map("CORRIDOR (1) 2000, 0, 0, 4000, 2000\n", "test");
  std::vector<Vec2> way;
  Pose pose{1.0, 0.0, 0.0};
  for (std::uint64_t cycle = 1; cycle < 20000 && !explorer.output().done; ++cycle) {
    way.push_back(pose.position());
    const double ahead = (std::cos(pose.th) > 0.0 ? 12.0 - pose.x : pose.x) - 0.2;
    const std::vector<lps::SonarReading> readings{
        {0, std::min(5.0, ahead), ahead < 5.0}, {1, 0.8, true}, {2, 0.8, true}};
    const Output& next = explorer.step({cycle, pose, map, way, readings});
    if (next.look_at)
      pose.th = std::atan2(next.look_at->y() - pose.y, next.look_at->x() - pose.x);
    else if (next.point_in_map && !(stays && next.reason == "the way back to the start"))
      pose.x += std::clamp(next.point_in_map->x() - pose.x, -0.03, 0.03);
  }
  EXPECT_TRUE(explorer.output().done);
  return explorer.left(map);
}

TEST(Explorer, SaysThatItDidNotComeBackToItsStart) {
  EXPECT_EQ(left_after_a_corridor(false), std::vector<std::string>{});
  EXPECT_EQ(left_after_a_corridor(true),
            std::vector<std::string>{"the way back to the start (no way leads there)"});
}

TEST(FreeFloor, SaysThatItGoesOnBeyondItsCells) {
  FreeFloor floor(std::vector<lps::SonarMount>{});
  for (double x = 0.0; x < FreeFloor::kReach - 0.7; x += 0.1)
    floor.add({x, 0.0, 0.0}, {});
  EXPECT_FALSE(floor.goes_on());
  floor.add({FreeFloor::kReach - 0.1, 0.0, 0.0}, {});
  EXPECT_TRUE(floor.goes_on());
}

// The robot finds its way on its own map: from its present place to a door at the other end.
TEST(Explore, TheRobotNavigatesByTheMapThatItBuilt) {
  Building built({.world = "loop"});
  built.run(20000);
  const std::vector<maps::Link> doors = built.whole.topology().links();
  const auto door = std::find_if(doors.begin(), doors.end(), [](const auto& l) {
    return (l.pose_in_map.position() - Vec2(11.95, 15.0)).norm() < 0.5;
  });
  ASSERT_NE(door, doors.end()) << "L7's";
  const auto status =
      built.whole.achieve("go-to-place", {saphira::text("place", std::to_string(door->id))}, 3000);
  EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
  EXPECT_LT((built.whole.truth().position() - Vec2(11.95, 15.6)).norm(), 1.2);
  EXPECT_EQ(built.whole.drive().contacts(), 0);
}

}  // namespace
}  // namespace saphira::explore
