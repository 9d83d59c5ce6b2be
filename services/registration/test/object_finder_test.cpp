#include "saphira/registration/object_finder.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace saphira::registration {
namespace {

using lps::PointType;

// A corridor of 20 by 3 m along x; the robot drives along y = -0.2.
maps::Map corridor() {
  maps::Map map;
  maps::Feature hall;
  hall.type = PointType::corridor;
  hall.id = 1;
  hall.length = 20.0;
  hall.width = 3.0;
  map.features.push_back(hall);
  maps::Feature door;
  door.type = PointType::door;
  door.id = 2;
  door.pose_in_map = {4.0, 1.5, -kPi / 2};
  door.width = 0.9;
  map.features.push_back(door);
  return map;
}

/// The reading of a sonar for a box of 0.6 by 0.4 m by the left wall at x = 1, and of that wall.
double range_of(const Pose& sensor, bool box) {
  const double to_wall = 1.5 - sensor.y;
  if (!box)
    return to_wall;
  // The cone meets an object that its axis misses.
  const double reach = 0.3 + (1.1 - sensor.y) * std::tan(radians(12.0));
  return std::abs(sensor.x - 1.0) < reach ? 1.1 - sensor.y : to_wall;
}

class ObjectFinderTest : public testing::Test {
 protected:
  /// Along the corridor, with a sonar to the left. Reported objects are put on the map.
  std::vector<maps::Feature> pass(bool box, double from = -1.0, double to = 3.0) {
    std::vector<maps::Feature> told;
    for (double x = from; x < to; x += 0.015) {
      const Look look{{x, -0.2, kPi / 2}, range_of({x, -0.2, kPi / 2}, box), true};
      for (maps::Feature thing : finder.step(map, field, ++cycle, {look})) {
        told.push_back(thing);
        if (thing.id != 0) {
          map.features.back() = thing;
        } else {
          thing.id = 100;
          map.features.push_back(thing);
        }
      }
    }
    return told;
  }

  maps::Map map = corridor();
  LineMap lines{map};
  Field field{map, lines};
  ObjectFinder finder;
  std::uint64_t cycle = 0;
};

TEST_F(ObjectFinderTest, ABoxByTheWallIsFoundWhereItStands) {
  const auto told = pass(true);
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.front().id, 0U);
  const maps::Feature& box = map.features.back();
  EXPECT_EQ(box.type, PointType::object);
  EXPECT_TRUE(box.learned);
  EXPECT_NEAR(box.pose_in_map.x, 1.0, 0.15);
  EXPECT_NEAR(box.length, 0.6, 0.25);
  // The sonar met its face at 1.1 m.
  EXPECT_NEAR(box.pose_in_map.y - box.width / 2.0, 1.1, 0.1);
  EXPECT_EQ(map.features.size(), 3U);
  EXPECT_TRUE(pass(true).empty());
}

TEST_F(ObjectFinderTest, WallsAndClosedDoorsAreNoThings) {
  EXPECT_TRUE(pass(false).empty());
  EXPECT_TRUE(pass(false, 3.0, 6.0).empty());
}

TEST_F(ObjectFinderTest, WhoWalksPastIsNoThing) {
  // Beside the robot at its speed, and towards it.
  for (const double speed : {0.03, -0.1})
    for (int i = 0; i < 60; ++i) {
      const double x = speed > 0.0 ? speed * i : 0.0;
      EXPECT_TRUE(
          finder.step(map, field, ++cycle, {{{x, -0.2, kPi / 2}, 1.0 + speed * 0.1 * i, true}})
              .empty() ||
          speed > 0.0);
    }
}

TEST_F(ObjectFinderTest, ARobotThatStandsFindsNothing) {
  for (int i = 0; i < 500; ++i)
    EXPECT_TRUE(finder.step(map, field, ++cycle, {{{1.0, -0.2, kPi / 2}, 1.3, true}}).empty());
}

TEST_F(ObjectFinderTest, WhatIsTakenFromTheMapAndStillThereIsFoundAgain) {
  ASSERT_FALSE(pass(true).empty());
  map.features.pop_back();
  EXPECT_TRUE(pass(false).empty());
  EXPECT_FALSE(pass(true).empty());
}

}  // namespace
}  // namespace saphira::registration
