#include "saphira/registration/standing.hpp"

#include <gtest/gtest.h>

namespace saphira::registration {
namespace {

constexpr int kSonars = 8;

/// Each sonar hears `range`, except `changed` of them, which hear the other one.
std::vector<PlacedReading> around(double range, int changed = 0, double other = 0.0) {
  std::vector<PlacedReading> readings;
  for (int sonar = 0; sonar < kSonars; ++sonar)
    readings.push_back({{0.0, 0.0, 2.0 * kPi * sonar / kSonars},
                        sonar < changed ? other : range + 0.1 * sonar,
                        true,
                        sonar});
  return readings;
}

/// The number of cycles in which it reports that the robot was carried.
int carried(Standing& standing, const std::vector<PlacedReading>& readings, int cycles,
            const Pose& moved = {}) {
  int times = 0;
  for (int i = 0; i < cycles; ++i)
    times += standing.step(moved, readings) ? 1 : 0;
  return times;
}

TEST(Standing, WhereAllAroundIsOtherThanBeforeItWasCarriedAndThatIsSaidOnce) {
  Standing standing;
  EXPECT_EQ(carried(standing, around(1.0), 20), 0);
  EXPECT_EQ(carried(standing, around(2.5), 50), 1);
}

TEST(Standing, OnePersonBesideItIsNoOtherPlace) {
  Standing standing;
  EXPECT_EQ(carried(standing, around(2.0), 20), 0);
  EXPECT_EQ(carried(standing, around(2.0, 2, 0.6), 300), 0) << "comes, and stays";
  EXPECT_EQ(carried(standing, around(2.0), 300), 0) << "goes";
}

/// The seven sonars of a Pioneer: five look ahead, one to each side.
std::vector<PlacedReading> of_pioneer(double ahead, double left, double right) {
  std::vector<PlacedReading> readings{{{0.0, 0.0, radians(90.0)}, left, true, 0}};
  for (int sonar = 1; sonar <= 5; ++sonar)
    readings.push_back({{0.0, 0.0, radians(45.0 - 15.0 * sonar)}, ahead, true, sonar});
  readings.push_back({{0.0, 0.0, radians(-90.0)}, right, true, 6});
  return readings;
}

TEST(Standing, APersonWhoLeavesFromBeforeAPioneerChangesOneSideOfItsSonars) {
  Standing standing;
  EXPECT_EQ(carried(standing, of_pioneer(0.8, 1.5, 2.0), 20), 0);
  EXPECT_EQ(carried(standing, of_pioneer(4.0, 1.5, 2.0), 300), 0);
  EXPECT_EQ(carried(standing, of_pioneer(2.0, 3.0, 0.9), 50), 1) << "another place";
}

TEST(Standing, WhatIsHeardBesidesFromTimeToTimeIsNothingNew) {
  Standing standing;
  for (int i = 0; i < 200; ++i) {
    std::vector<PlacedReading> readings = around(1.5);
    for (PlacedReading& reading : readings)
      reading.echo = (i + reading.sonar) % 3 != 0;
    EXPECT_FALSE(standing.step({}, readings)) << i;
  }
}

TEST(Standing, AlongItsOwnWayEverythingChangesHoweverSlowlyItDrives) {
  for (const double step : {0.03, 0.005, 0.001}) {
    Standing standing;
    for (int i = 0; i < 1000; ++i)
      EXPECT_FALSE(standing.step({step, 0.0, 0.0}, around(1.0 + step * i))) << step << ", " << i;
  }
}

TEST(Standing, WhileItTurnsSlowlyEverythingChanges) {
  Standing standing;
  for (int i = 0; i < 1000; ++i)
    EXPECT_FALSE(standing.step({0.0, 0.0, radians(0.5)}, around(1.0 + 0.01 * i))) << i;
}

}  // namespace
}  // namespace saphira::registration
