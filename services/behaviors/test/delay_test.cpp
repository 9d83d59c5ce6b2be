#include <gtest/gtest.h>

#include "pioneer.hpp"
#include "saphira/behaviors/executive.hpp"
#include "saphira/behaviors/foresight.hpp"

// The executive with old inputs.
namespace saphira::behaviors {
namespace {

TEST(Foresight, GoesOnStraightAndAlongAnArc) {
  RobotNow robot{{1.0, 2.0, 0.0}, 0.3, 0.0, 0.0};
  RobotNow ahead = foresee(robot, 0.5);
  EXPECT_NEAR(ahead.pose_in_odom.x, 1.15, 1e-12);
  EXPECT_NEAR(ahead.pose_in_odom.y, 2.0, 1e-12);
  EXPECT_EQ(ahead.velocity, 0.3);

  robot.rotation_velocity = 1.0;
  robot.target_heading_in_odom = 2.0;
  ahead = foresee(robot, 0.5);
  EXPECT_NEAR(ahead.pose_in_odom.th, 0.5, 1e-12);
  EXPECT_GT(ahead.pose_in_odom.y, 2.0);
}

TEST(Foresight, TurnsNoFurtherThanItWasTold) {
  for (const double side : {1.0, -1.0}) {
    const RobotNow robot{{0.0, 0.0, kPi}, 0.0, side, norm2_angle(kPi + side * 0.2)};
    EXPECT_NEAR(norm2_angle(foresee(robot, 0.5).pose_in_odom.th - kPi), side * 0.2, 1e-12);
    // A turn beyond the setpoint, or against it, is coming to an end.
    const RobotNow past{{0.0, 0.0, 0.0}, 0.0, side, -side * 0.1};
    EXPECT_EQ(foresee(past, 0.5).pose_in_odom.th, 0.0);
  }
}

class DelayTest : public ::testing::Test {
 protected:
  /// A cycle with an intent of `age` cycles ago; the robot drives ahead at 0.4 m/s.
  Output step(std::uint64_t age, double delay = 0.0, std::vector<lps::SonarReading> sonars = {}) {
    ++cycle;
    const Intent intent{cycle - age, true, {{"on", "ConstantVelocity", 2, true, {{"speed", 0.4}}}}};
    return executive.step({cycle, robot, std::move(sonars), &intent, delay});
  }

  Executive executive{predefined(), pioneer()};
  RobotNow robot;
  std::uint64_t cycle = 100;
};

TEST_F(DelayTest, WhatIsFreshIsNotLimited) {
  for (int i = 0; i < 20; ++i) {
    const Output output = step(1);
    ASSERT_EQ(output.speed, 0.4);
    ASSERT_LT(output.speed_limit, 0.0);
    ASSERT_EQ(output.limit_reason, "");
    ASSERT_EQ(output.slow, "");
    ASSERT_DOUBLE_EQ(output.input_age, 0.1);
  }
}

TEST_F(DelayTest, TheOlderTheIntentTheSlower) {
  double before = 1.0;
  for (std::uint64_t age = 6; age < 30; ++age) {
    const Output output = step(age);
    ASSERT_TRUE(output.active) << output.inactive_reason;
    ASSERT_LT(output.speed, before);
    ASSERT_NEAR(output.speed * 0.1 * static_cast<double>(age - 1), kUnseenWay, 1e-9);
    ASSERT_NEAR(output.input_age, 0.1 * static_cast<double>(age), 1e-9);
    before = output.speed;
    cycle += 1;  // the ages grow, and each intent is newer than the one before
  }
  EXPECT_NE(step(30).limit_reason.find("intentions are 2.9 s old"), std::string::npos);
}

TEST_F(DelayTest, AnIntentOfLongAgoDoesNotDrive) {
  EXPECT_TRUE(step(30).active);
  const Output output = step(33);
  EXPECT_FALSE(output.active);
  EXPECT_NE(output.inactive_reason.find("too old to drive by"), std::string::npos)
      << output.inactive_reason;
}

// Silence separates a cut from a delay.
TEST_F(DelayTest, ACutStopsItAsSoonHoweverSlowTheNetworkIs) {
  for (const std::uint64_t usual : {1U, 3U, 7U, 20U}) {
    for (int i = 0; i < 30; ++i)
      ASSERT_TRUE(step(usual).active);
    EXPECT_TRUE(step(usual + 1).active) << usual;
    const Output output = step(usual + 2);
    EXPECT_FALSE(output.active) << usual;
    EXPECT_NE(output.inactive_reason.find("no newer intent has come for 2 cycles"),
              std::string::npos)
        << output.inactive_reason;
  }
}

TEST_F(DelayTest, AfterACutItDrivesAsBefore) {
  ASSERT_EQ(step(1).speed, 0.4);
  // The link is cut for four seconds: the robot's state returns before the next intent.
  cycle += 40;
  EXPECT_FALSE(step(42).active);
  for (int i = 0; i < 5; ++i) {
    const Output output = step(1);
    ASSERT_TRUE(output.active) << output.inactive_reason;
    ASSERT_EQ(output.speed, 0.4);
    ASSERT_EQ(output.slow, "");
  }
}

TEST_F(DelayTest, OneOldIntentIsSoonForgotten) {
  step(1);
  EXPECT_FALSE(step(45).active) << "it came late, and is the newest";
  for (int i = 0; i < 20; ++i)
    step(1);
  EXPECT_TRUE(step(1).active);
  for (int i = 0; i < 60; ++i)
    step(1);
  EXPECT_EQ(step(1).speed, 0.4);
}

TEST_F(DelayTest, LossAndJitterDoNotMakeTheSpeedJump) {
  double low = 1.0, high = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Output output = step(i % 5 == 0 ? 7 : 6);
    if (i < 10)
      continue;
    low = std::min(low, output.speed);
    high = std::max(high, output.speed);
  }
  EXPECT_LT(high - low, 0.03);
}

TEST_F(DelayTest, TheDelayOfTheCommandsCountsAsWell) {
  Output output = step(1, 0.5);
  EXPECT_NEAR(output.speed, kUnseenWay / 0.5, 1e-9);
  EXPECT_NE(output.limit_reason.find("commands take effect 0.5 s late"), std::string::npos)
      << output.limit_reason;
  EXPECT_NEAR(output.input_age, 0.1, 1e-9) << "of what the step used";
  output = step(6, 0.5);
  EXPECT_NEAR(output.speed, kUnseenWay / 1.0, 1e-9);
}

TEST_F(DelayTest, WhatIsNearStopsItBeforeTheWordThatItIsNearerWould) {
  // The middle sonar has an echo 0.18 m ahead of the hull, in each cycle.
  const std::vector<lps::SonarReading> near{{3, 0.30, true}};
  double slowest = 1.0;
  Output output;
  for (int i = 0; i < 10; ++i)
    output = step(1, 0.5, near);
  slowest = output.speed;
  EXPECT_LT(slowest, kUnseenWay / 0.5) << "less than what the age alone allows";
  EXPECT_NE(output.limit_reason.find("are free"), std::string::npos) << output.limit_reason;
}

TEST_F(DelayTest, BehaviorsSeeTheRobotWhereTheirCommandWillFindIt) {
  robot = {{1.0, 0.0, 0.0}, 0.0, 0.5, 0.25};
  EXPECT_NEAR(step(1, 0.0).heading_in_odom, 0.0, 1e-9);
  EXPECT_NEAR(step(1, 0.4).heading_in_odom, 0.2, 1e-9) << "straight on, from where it points then";
}

}  // namespace
}  // namespace saphira::behaviors
