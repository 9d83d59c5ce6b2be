#include "saphira/lps/obstacle_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "saphira/base/random.hpp"

namespace saphira::lps {
namespace {

constexpr Pose kOrigin{};

/// Its robot begins at the origin.
class ObstacleMemoryTest : public testing::Test {
 protected:
  ObstacleMemoryTest() { memory.move_to(kOrigin); }
  /// Distance [m] from a place in the robot's frame to the nearest obstacle.
  double nearest(const Vec2& place, const Pose& robot = kOrigin) {
    memory.collect(robot);
    double best = 1e9;
    for (const Vec2& p : memory.points())
      best = std::min(best, (p - place).norm());
    return best;
  }

  ObstacleMemory memory;
};

TEST_F(ObstacleMemoryTest, BelievesTheFirstEcho) {
  memory.echo(kOrigin, 1.0);
  EXPECT_LT(nearest({1.0, 0.0}), 0.06);
  // It is on the arc, and nowhere else.
  for (const Vec2& p : memory.points())
    EXPECT_NEAR(p.norm(), 1.0, 0.06);
}

TEST_F(ObstacleMemoryTest, KeepsWhatLeavesTheSonarsSight) {
  memory.echo(kOrigin, 1.0);
  memory.echo(kOrigin, 1.0);
  const Pose later{0.8, -0.3, 0.0};
  for (int cycle = 0; cycle < 40; ++cycle)
    memory.move_to(later);
  EXPECT_LT(nearest({0.2, 0.3}, later), 0.06);
}

TEST_F(ObstacleMemoryTest, ForgetsInTime) {
  memory.echo(kOrigin, 1.0);
  for (int cycle = 0; cycle < 200; ++cycle)
    memory.move_to(kOrigin);
  memory.collect(kOrigin);
  EXPECT_TRUE(memory.points().empty());
}

TEST(ObstacleMemory, MayForgetNothingAtRest) {
  ObstacleMemory memory({.keeps_at_rest = true});
  memory.move_to(kOrigin);
  memory.echo(kOrigin, 1.0);
  for (int cycle = 0; cycle < 2000; ++cycle)
    memory.move_to({0.0005 * (cycle % 2), 0.0, 0.5 * (cycle % 3)});
  memory.collect(kOrigin);
  EXPECT_FALSE(memory.points().empty()) << "it turned on the spot";
  for (int cycle = 0; cycle < 100; ++cycle)
    memory.move_to({0.01 * (cycle % 2), 0.0, 0.0});
  memory.collect(kOrigin);
  EXPECT_TRUE(memory.points().empty()) << "it drove";
}

TEST_F(ObstacleMemoryTest, GoesWithTheRobot) {
  memory.echo(kOrigin, 1.0);
  Pose robot;
  for (robot.x = 0.0; robot.x < 1.9; robot.x += 0.1)
    memory.move_to(robot);
  EXPECT_LT(nearest({1.0 - robot.x, 0.0}, robot), 0.06);
  // Obstacles outside of its grid are left behind.
  for (; robot.x < 5.0; robot.x += 0.1)
    memory.move_to(robot);
  memory.collect(robot);
  EXPECT_TRUE(memory.points().empty());
}

TEST_F(ObstacleMemoryTest, AnEchoFromBehindDisproves) {
  memory.echo(kOrigin, 1.0);
  memory.echo(kOrigin, 2.0);
  memory.echo(kOrigin, 2.0);
  EXPECT_GT(nearest({1.0, 0.0}), 0.15);
  EXPECT_LT(nearest({2.0, 0.0}), 0.06);
}

TEST_F(ObstacleMemoryTest, SilenceDisprovesMoreSlowly) {
  memory.echo(kOrigin, 0.8);
  memory.silence(kOrigin);
  EXPECT_LT(nearest({0.8, 0.0}), 0.06);
  memory.silence(kOrigin);
  EXPECT_GT(nearest({0.8, 0.0}), 0.1);
}

TEST_F(ObstacleMemoryTest, SilenceFromFarAwaySaysNothing) {
  memory.echo(kOrigin, 1.2);
  for (int i = 0; i < 9; ++i)
    memory.silence(kOrigin);
  EXPECT_LT(nearest({1.2, 0.0}), 0.06);
}

TEST_F(ObstacleMemoryTest, BeamsBesideItSayNothing) {
  memory.echo(kOrigin, 1.0);
  for (int i = 0; i < 9; ++i)
    memory.silence({0.0, 0.0, radians(25)});
  EXPECT_LT(nearest({1.0, 0.0}), 0.06);
}

// A gap whose edge only the outer half of a beam meets: the neighbouring beam goes through, so the
// echo is put outside of the neighbour's cone.
TEST_F(ObstacleMemoryTest, NeighboursNarrowTheArc) {
  const Pose neighbour{0.0, 0.0, radians(-15)};
  memory.echo(neighbour, 2.0);
  memory.echo(kOrigin, 1.0);
  memory.echo(neighbour, 2.0);
  memory.collect(kOrigin);
  double middle = 0.0;
  int n = 0;
  for (const Vec2& p : memory.points())
    if (p.norm() < 1.5) {
      middle += p.y();
      ++n;
    }
  ASSERT_GT(n, 0);
  EXPECT_GT(middle / n, 0.03);
  EXPECT_GT(nearest({std::cos(radians(-11)), std::sin(radians(-11))}), 0.06);
}

// The infrared sensors of a Khepera, whose cone is no longer than a cell of the others' grid.
TEST(ObstacleMemory, AShortRangeHasAFineGrid) {
  const double range = 0.06;
  for (int i = 0; i < 50; ++i)
    for (const double distance : {0.01, 0.03, 0.05}) {
      ObstacleMemory memory(for_range(range));
      const Pose sonar{0.013 * i, 0.007 * i, radians(7.0 * i)};
      memory.move_to(sonar);
      memory.echo(sonar, distance);
      memory.collect(sonar);
      ASSERT_FALSE(memory.points().empty()) << i << " at " << distance;
      for (const Vec2& p : memory.points())
        EXPECT_NEAR(p.norm(), distance, 0.006) << i;
    }
}

TEST(ObstacleMemory, SilenceSaysNothingOfWhatIsOutOfRange) {
  ObstacleMemory memory(for_range(0.06));
  memory.move_to(kOrigin);
  memory.echo(kOrigin, 0.05);
  const Pose behind{-0.05, 0.0, 0.0};
  for (int i = 0; i < 9; ++i)
    memory.silence(behind);
  memory.collect(kOrigin);
  EXPECT_FALSE(memory.points().empty());
  for (int i = 0; i < 9; ++i)
    memory.silence(kOrigin);
  memory.collect(kOrigin);
  EXPECT_TRUE(memory.points().empty());
}

TEST(ObstacleMemory, ATouchIsAsFineAsTheGrid) {
  ObstacleMemory memory(for_range(0.06));
  memory.move_to(kOrigin);
  memory.touch({0.028, 0.0});
  memory.collect(kOrigin);
  ASSERT_FALSE(memory.points().empty());
  for (const Vec2& p : memory.points())
    EXPECT_LT((p - Vec2(0.028, 0.0)).norm(), 0.011) << "the robot is not inside of it";
}

TEST_F(ObstacleMemoryTest, WhatWasTouchedIsAnObstacleUntilBeamsFindItsPlaceEmpty) {
  memory.touch({0.3, 0.0});
  memory.collect({});
  ASSERT_FALSE(memory.points().empty());
  for (const Vec2& point : memory.points())
    EXPECT_LT((point - Vec2(0.3, 0.0)).norm(), 0.1 + 1e-9);
  for (int i = 0; i < 12; ++i)
    memory.echo(kOrigin, 2.0);
  EXPECT_GT(nearest({0.35, 0.0}), 0.06) << "the beam passes here";
}

/// The points of a drive with random turns and echoes, to the bit: in odom it jumps now and then.
std::uint64_t hash_of_a_drive(const MemorySettings& settings) {
  ObstacleMemory memory(settings);
  Random random(7);
  Pose robot;
  std::uint64_t hash = 0;
  for (int cycle = 0; cycle < 3000; ++cycle) {
    robot = compose(robot, {random.uniform(0.0, 0.06), 0.0, random.uniform(-0.2, 0.2)});
    if (cycle % 700 == 699)
      robot = compose(robot, {cycle % 2100 == 2099 ? 90.0 : -1.3, 0.4, 0.0});
    memory.move_to(robot);
    for (int beam = 0; beam < 4; ++beam) {
      const Pose sonar = compose(robot, {0.1, 0.0, random.uniform(-kPi, kPi)});
      if (const double range = random.uniform(0.1, 4.0); range < 2.5)
        memory.echo(sonar, range);
      else
        memory.silence(sonar);
    }
    memory.collect(robot);
    for (const Vec2& point : memory.points())
      for (const double one : {point.x(), point.y()})
        hash = (hash ^ std::bit_cast<std::uint64_t>(one)) * 0x100000001b3ULL;
  }
  return hash;
}

TEST(ObstacleMemory, ItsPointsAreTheSameToTheBit) {
  EXPECT_EQ(hash_of_a_drive({}), 9941136115185523041U);
  MemorySettings cautious{.least = 0.0, .fading = 0.985, .keeps_at_rest = true};
  EXPECT_EQ(hash_of_a_drive(for_range(1.0, cautious)), 338579420589337697U);
}

}  // namespace
}  // namespace saphira::lps
