#include "saphira/reflector/motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace saphira::reflector {
namespace {

const Limits kPioneer{0.4, radians(100.0), 0.5};

TEST(DirectMotion, TheChannelsAreIndependent) {
  DirectMotion direct(kPioneer);
  Motion m{.translation = Translation::velocity, .velocity = 0.2};
  direct.set(m, {});
  EXPECT_EQ(direct.setpoints(), (Setpoints{0.2, false, 0.0, 0.0}));
  m = {};
  m.rotation = Rotation::heading;
  m.heading = 1.0;
  direct.set(m, {});
  EXPECT_EQ(direct.setpoints(), (Setpoints{0.2, true, 1.0, 0.0}));
  m.rotation = Rotation::velocity;
  m.rotation_velocity = -0.5;
  direct.set(m, {});
  EXPECT_FALSE(direct.setpoints().turn_to_heading);
  EXPECT_EQ(direct.setpoints().rotation_velocity, -0.5);
  direct.stop();
  EXPECT_EQ(direct.setpoints(), Setpoints{});
}

TEST(DirectMotion, ARelativeHeadingIsTakenOnce) {
  DirectMotion direct(kPioneer);
  Motion m{.move = 1, .rotation = Rotation::relative_heading, .heading = kPi / 2};
  direct.set(m, {0, 0, 3.0});
  EXPECT_NEAR(direct.setpoints().heading_in_odom, norm2_angle(3.0 + kPi / 2), 1e-12);
  direct.set(m, {0, 0, 3.5});
  EXPECT_NEAR(direct.setpoints().heading_in_odom, norm2_angle(3.0 + kPi / 2), 1e-12)
      << "the same move again";
  EXPECT_TRUE(direct.setpoints().turn_to_heading);
  m.move = 2;
  direct.set(m, {0, 0, 3.5});
  EXPECT_NEAR(direct.setpoints().heading_in_odom, norm2_angle(3.5 + kPi / 2), 1e-12);
}

TEST(DirectMotion, AMoveThatAVelocityHasEndedIsNotThatVelocity) {
  DirectMotion direct(kPioneer);
  const Motion move{.translation = Translation::position,
                    .distance = 1.0,
                    .move = 1,
                    .rotation = Rotation::relative_heading,
                    .heading = 1.0};
  direct.set(move, {});
  direct.set({.translation = Translation::velocity,
              .velocity = 0.3,
              .rotation = Rotation::velocity,
              .rotation_velocity = 0.5},
             {});
  direct.set(move, {});
  EXPECT_EQ(direct.setpoints().velocity, 0.0);
  EXPECT_EQ(direct.setpoints().rotation_velocity, 0.0);
}

TEST(DirectMotion, AMoveThatIsOverStaysSoWhoeverElseDrives) {
  DirectMotion direct(kPioneer);
  Motion mine{.translation = Translation::position, .distance = 1.0, .move = 5, .driver = 1};
  direct.set(mine, {});
  for (std::uint64_t driver = 2; driver < 1000; ++driver) {
    direct.stop();
    Motion other = mine;
    other.driver = driver;
    direct.set(other, {});
    direct.stop();
    direct.set(mine, {});
    ASSERT_EQ(direct.setpoints().velocity, 0.0) << driver;
  }
}

TEST(DirectMotion, AnInterruptedMoveIsOver) {
  DirectMotion direct(kPioneer);
  Motion m{.translation = Translation::position, .distance = 1.0, .move = 7, .driver = 1};
  direct.set(m, {});
  EXPECT_GT(direct.setpoints().velocity, 0.0);
  direct.stop();
  direct.set(m, {});
  EXPECT_EQ(direct.setpoints().velocity, 0.0);
  m.driver = 2;
  direct.set(m, {});
  EXPECT_GT(direct.setpoints().velocity, 0.0) << "another one's seventh move";
}

/// A robot that follows velocity setpoints with the accelerations of the manual's Pioneer, with
/// packets every 0.1 s, and a delay of one packet.
double drive(DirectMotion& direct, double* top, double* overshoot, double distance) {
  double v = 0.0;
  double x = 0.0;
  double setpoint = 0.0;
  *top = 0.0;
  *overshoot = 0.0;
  double told = 0.0;
  for (int cycle = 0; cycle < 600; ++cycle) {
    direct.moved(x - told);
    told = x;
    const double next = direct.setpoints().velocity;
    for (int tick = 0; tick < 10; ++tick) {
      if (tick == 3)
        setpoint = next;  // the way of the packets
      const double slower = std::abs(setpoint) < std::abs(v) ? 2.0 : 0.5;
      v += std::clamp(setpoint - v, -slower * 0.01, slower * 0.01);
      x += v * 0.01;
      *top = std::max(*top, std::abs(v));
      *overshoot = std::max(*overshoot, (x - distance) * (distance > 0 ? 1 : -1));
    }
  }
  EXPECT_NEAR(v, 0.0, 1e-9) << "at rest";
  return x;
}

TEST(DirectMotion, APositionIsReachedWithinTheManualsTolerance) {
  for (const double distance : {1.0, -1.0, 0.3, 0.05, 5.0, -0.02}) {
    for (const double speed : {0.0, 0.1, 0.2, 0.4}) {
      DirectMotion direct(kPioneer);
      Motion m{
          .translation = Translation::position, .velocity = speed, .distance = distance, .move = 1};
      direct.set(m, {});
      EXPECT_EQ(direct.distance_left(), distance);
      double top = 0.0;
      double overshoot = 0.0;
      const double x = drive(direct, &top, &overshoot, distance);
      EXPECT_NEAR(x, distance, 0.01) << distance << " at " << speed;
      EXPECT_LT(overshoot, 0.01);
      EXPECT_LE(top, (speed > 0.0 ? speed : 0.4) + 1e-9);
      EXPECT_NEAR(direct.distance_left(), 0.0, 0.1);
      direct.set(m, {});
      EXPECT_NEAR(direct.distance_left(), 0.0, 0.1) << "the same move again does not begin anew";
      m.move = 2;
      direct.set(m, {});
      EXPECT_NEAR(direct.distance_left(), distance, 1e-9);
    }
  }
}

}  // namespace
}  // namespace saphira::reflector
