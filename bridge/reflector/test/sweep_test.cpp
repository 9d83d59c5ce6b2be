#include "saphira/reflector/sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace saphira::reflector {
namespace {

const double kAngle = radians(8.5);

TEST(Sweep, SwingsAHeadingToBothSidesAndEndsOnIt) {
  Sweep sweep;
  double left = 0.0;
  double right = 0.0;
  for (std::uint64_t cycle = 100; cycle < 160; ++cycle) {
    Setpoints setpoints{0.3, true, 1.0, 0.0};
    sweep.step(cycle, cycle == 100, kAngle, setpoints);
    const double off = setpoints.heading_in_odom - 1.0;
    left = std::max(left, off);
    right = std::min(right, off);
    EXPECT_NEAR(cycle >= 129 ? off : 0.0, 0.0, 1e-9) << cycle;
    EXPECT_EQ(setpoints.velocity, 0.3);
  }
  EXPECT_NEAR(left, kAngle, 0.01);
  EXPECT_NEAR(right, -kAngle, 0.01);
}

TEST(Sweep, OfARotationEndsAtTheSameHeading) {
  Sweep sweep;
  double heading = 0.0;
  double left = 0.0;
  for (std::uint64_t cycle = 100; cycle < 160; ++cycle) {
    Setpoints setpoints{0.3, false, 0.0, 0.05};
    sweep.step(cycle, cycle == 100, kAngle, setpoints);
    sweep.step(cycle, false, kAngle, setpoints = {0.3, false, 0.0, 0.05});
    heading += 0.1 * (setpoints.rotation_velocity - 0.05);
    left = std::max(left, heading);
  }
  EXPECT_NEAR(heading, 0.0, 1e-9);
  EXPECT_NEAR(left, kAngle, 0.02);
}

TEST(Sweep, EndsWithAStopAndWithATurn) {
  for (const Setpoints& other : {Setpoints{0.0, true, 1.0, 0.0}, Setpoints{0.3, true, 1.5, 0.0},
                                 Setpoints{0.3, false, 0.0, 0.6}}) {
    Sweep sweep;
    Setpoints setpoints{0.3, true, 1.0, 0.0};
    sweep.step(100, true, kAngle, setpoints);
    setpoints = other;
    sweep.step(101, false, kAngle, setpoints);
    EXPECT_EQ(setpoints, other);
    sweep.step(102, false, kAngle, setpoints = {0.3, true, 1.0, 0.0});
    EXPECT_EQ(setpoints.heading_in_odom, 1.0);
  }
}

TEST(Sweep, FollowsTheCourseOfADriverWhoSteersFromThePresentHeading) {
  // As behaviors do: half of the way to a goal at heading 0, from where the robot is.
  Sweep sweep;
  double heading = 0.0;
  double left = 0.0;
  double right = 0.0;
  for (std::uint64_t cycle = 100; cycle < 220; ++cycle) {
    Setpoints setpoints{0.3, true, 0.5 * heading, 0.0};
    sweep.step(cycle, true, kAngle, setpoints);
    heading += std::clamp(setpoints.heading_in_odom - heading, -0.05, 0.05);
    left = std::max(left, heading);
    right = std::min(right, heading);
  }
  EXPECT_GT(left, kAngle);
  EXPECT_LT(left, 2.0 * kAngle);
  EXPECT_LT(right, -kAngle);
  EXPECT_GT(right, -2.0 * kAngle);
}

}  // namespace
}  // namespace saphira::reflector
