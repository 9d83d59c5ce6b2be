#include "saphira/authority/approaches.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "saphira/base/random.hpp"

namespace saphira::authority {
namespace {

const Pose kAhead{0.2, 0.0, 0.0};

class ApproachesTest : public ::testing::Test {
 protected:
  /// The sonar ahead fires every third cycle, as a Pioneer's do.
  void fire(std::optional<double> range, const Pose& robot_in_odom = {},
            const std::vector<Vec2>& known = {}) {
    cycle += 3;
    robot = robot_in_odom;
    approaches.hear(cycle, robot, {3, kAhead, range}, known);
  }
  std::vector<Approach> now(std::uint64_t later = 0) const {
    return approaches.now(cycle + later, robot);
  }

  Approaches approaches;
  std::uint64_t cycle = 0;
  Pose robot;
};

TEST_F(ApproachesTest, SomebodyWalksTowardsTheRobot) {
  fire(2.4);
  EXPECT_TRUE(now().empty());
  fire(2.01);
  ASSERT_EQ(now().size(), 1U);
  EXPECT_NEAR(now()[0].closing, 1.3, 1e-9);
  EXPECT_NEAR(now()[0].at_in_robot.x(), 2.21, 1e-9);
  EXPECT_NEAR(now(5)[0].at_in_robot.x(), 2.21 - 0.65, 1e-9) << "comes on where no beam looks";
}

TEST_F(ApproachesTest, WhatHasComeStandsThereForAWhile) {
  fire(1.5);
  fire(1.1);
  EXPECT_GT(now(10).at(0).closing, 0.0);
  EXPECT_EQ(now(11).at(0).closing, 0.0);
  EXPECT_LT(now(11).at(0).at_in_robot.norm(), 0.1);
  EXPECT_EQ(now(50).size(), 1U);
  EXPECT_TRUE(now(51).empty());
}

TEST_F(ApproachesTest, TheRobotsOwnWayIsNone) {
  // Towards a wall at 0.8 m/s.
  for (int i = 0; i < 8; ++i) {
    fire(2.4 - 0.24 * i, {0.24 * i, 0.0, 0.0});
    EXPECT_TRUE(now().empty()) << i;
  }
}

TEST_F(ApproachesTest, AnotherThingIsNone) {
  fire(2.4);
  fire(0.9);
  EXPECT_TRUE(now().empty()) << "faster than anybody runs";
  fire(2.4);
  fire(2.0, {0.0, 0.0, radians(10.0)});
  EXPECT_TRUE(now().empty()) << "the sonar looks elsewhere";
  fire(std::nullopt);
  fire(2.0);
  EXPECT_TRUE(now().empty()) << "silence is no distance";
  fire(2.4);
  fire(2.0, {}, {{2.25, 0.1}});
  EXPECT_TRUE(now().empty()) << "known to stand there";
}

TEST_F(ApproachesTest, AnEchoThatComesAndGoesIsNewsOnce) {
  for (int i = 0; i < 40; ++i) {
    fire(2.4);
    fire(2.0);
  }
  EXPECT_TRUE(now().empty()) << "or a robot beside a wall at a slant would stand for ever";
  cycle += 60;
  fire(2.4);
  fire(2.0);
  EXPECT_EQ(now().size(), 1U);
}

TEST_F(ApproachesTest, ForgetsOnClear) {
  fire(2.4);
  fire(2.0);
  approaches.clear();
  EXPECT_TRUE(now().empty());
  fire(1.6);
  EXPECT_TRUE(now().empty());
}

// Whatever the sonars say, what is told is finite and in front of its sonar.
TEST_F(ApproachesTest, TellsNothingOutrageous) {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    cycle += static_cast<std::uint64_t>(random.uniform(0.0, 8.0));
    robot = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-0.1, 0.1)};
    approaches.hear(
        cycle, robot,
        {static_cast<int>(random.uniform(0.0, 8.0)), kAhead,
         random.chance(0.2) ? std::nullopt : std::optional<double>(random.uniform(0.0, 6.0))},
        {});
    for (const Approach& approach : now()) {
      ASSERT_GE(approach.closing, 0.0);
      ASSERT_LE(approach.closing, 2.5);
      ASSERT_LE(approach.at_in_robot.norm(), 6.0);
    }
  }
}

}  // namespace
}  // namespace saphira::authority
