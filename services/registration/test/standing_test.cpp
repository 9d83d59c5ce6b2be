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
  EXPECT_EQ(carried(standing, around(1.0), 6), 0);
  EXPECT_EQ(carried(standing, around(2.5), 2), 0);
  EXPECT_EQ(carried(standing, around(2.5), 1), 1) << "by the third readings";
  EXPECT_EQ(carried(standing, around(2.5), 50), 0);
}

TEST(Standing, ACorridorThatIsNarrowerByAHandIsAnotherPlace) {
  for (const double shift : {-0.05, 0.05}) {
    Standing standing;
    EXPECT_EQ(carried(standing, around(1.0), 20), 0);
    EXPECT_EQ(carried(standing, around(1.0 + shift), 20), 1) << shift;
  }
  Standing standing;
  EXPECT_EQ(carried(standing, around(1.0), 20), 0);
  EXPECT_EQ(carried(standing, around(1.03), 20), 0) << "noise";
}

TEST(Standing, FortyPercentOfTheSonarsAreAllAround) {
  Standing standing;
  EXPECT_EQ(carried(standing, around(2.0), 20), 0);
  EXPECT_EQ(carried(standing, around(2.0, 3, 0.6), 20), 0) << "3 of 8";
  EXPECT_EQ(carried(standing, around(2.0, 0), 20), 0);
  EXPECT_EQ(carried(standing, around(2.0, 4, 0.6), 20), 1) << "4 of 8";
}

TEST(Standing, APersonWhoWalksAroundItChangesOneSideAfterTheOther) {
  for (const int each : {4, 6, 12}) {  // [cycles] before one pair of sonars
    Standing standing;
    EXPECT_EQ(carried(standing, around(2.0), 20), 0);
    for (int i = 0; i < 400; ++i) {
      std::vector<PlacedReading> readings = around(2.0);
      for (const int beside : {0, 1})
        readings[static_cast<std::size_t>((i / each + beside) % kSonars)].range = 0.7;
      EXPECT_FALSE(standing.step({}, readings)) << each << ", " << i;
    }
  }
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
