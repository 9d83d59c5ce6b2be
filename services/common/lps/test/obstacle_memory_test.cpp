#include "saphira/lps/obstacle_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace saphira::lps {
namespace {

constexpr Pose kOrigin{};

/// Distance [m] from a place in the robot's frame to the nearest obstacle.
double nearest(const ObstacleMemory& memory, const Vec2& place) {
  double best = 1e9;
  for (const Vec2& p : memory.points())
    best = std::min(best, (p - place).norm());
  return best;
}

TEST(ObstacleMemory, BelievesTheFirstEcho) {
  ObstacleMemory memory;
  memory.move_to(kOrigin);
  memory.echo(kOrigin, 1.0);
  memory.collect(kOrigin);
  EXPECT_LT(nearest(memory, {1.0, 0.0}), 0.06);
  // It is on the arc, and nowhere else.
  for (const Vec2& p : memory.points())
    EXPECT_NEAR(p.norm(), 1.0, 0.06);
}

TEST(ObstacleMemory, KeepsWhatLeavesTheSonarsSight) {
  ObstacleMemory memory;
  memory.move_to(kOrigin);
  memory.echo(kOrigin, 1.0);
  memory.echo(kOrigin, 1.0);
  const Pose later{0.8, -0.3, 0.0};
  for (int cycle = 0; cycle < 40; ++cycle)
    memory.move_to(later);
  memory.collect(later);
  EXPECT_LT(nearest(memory, {0.2, 0.3}), 0.06);
}

TEST(ObstacleMemory, ForgetsInTime) {
  ObstacleMemory memory;
  memory.move_to(kOrigin);
  memory.echo(kOrigin, 1.0);
  for (int cycle = 0; cycle < 200; ++cycle)
    memory.move_to(kOrigin);
  memory.collect(kOrigin);
  EXPECT_TRUE(memory.points().empty());
}

TEST(ObstacleMemory, GoesWithTheRobot) {
  ObstacleMemory memory;
  memory.move_to(kOrigin);
  memory.echo(kOrigin, 1.0);
  Pose robot;
  for (robot.x = 0.0; robot.x < 1.9; robot.x += 0.1)
    memory.move_to(robot);
  memory.collect(robot);
  EXPECT_LT(nearest(memory, {1.0 - robot.x, 0.0}), 0.06);
  // Obstacles outside of its grid are left behind.
  for (; robot.x < 5.0; robot.x += 0.1)
    memory.move_to(robot);
  memory.collect(robot);
  EXPECT_TRUE(memory.points().empty());
}

TEST(ObstacleMemory, AnEchoFromBehindDisproves) {
  ObstacleMemory memory;
  memory.move_to(kOrigin);
  memory.echo(kOrigin, 1.0);
  memory.echo(kOrigin, 2.0);
  memory.echo(kOrigin, 2.0);
  memory.collect(kOrigin);
  EXPECT_GT(nearest(memory, {1.0, 0.0}), 0.15);
  EXPECT_LT(nearest(memory, {2.0, 0.0}), 0.06);
}

TEST(ObstacleMemory, SilenceDisprovesMoreSlowly) {
  ObstacleMemory memory;
  memory.move_to(kOrigin);
  memory.echo(kOrigin, 0.8);
  memory.silence(kOrigin);
  memory.collect(kOrigin);
  EXPECT_LT(nearest(memory, {0.8, 0.0}), 0.06);
  memory.silence(kOrigin);
  memory.collect(kOrigin);
  EXPECT_GT(nearest(memory, {0.8, 0.0}), 0.1);
}

TEST(ObstacleMemory, SilenceFromFarAwaySaysNothing) {
  ObstacleMemory memory;
  memory.move_to(kOrigin);
  memory.echo(kOrigin, 1.2);
  for (int i = 0; i < 9; ++i)
    memory.silence(kOrigin);
  memory.collect(kOrigin);
  EXPECT_LT(nearest(memory, {1.2, 0.0}), 0.06);
}

TEST(ObstacleMemory, BeamsBesideItSayNothing) {
  ObstacleMemory memory;
  memory.move_to(kOrigin);
  memory.echo(kOrigin, 1.0);
  for (int i = 0; i < 9; ++i)
    memory.silence({0.0, 0.0, radians(25)});
  memory.collect(kOrigin);
  EXPECT_LT(nearest(memory, {1.0, 0.0}), 0.06);
}

// A gap whose edge only the outer half of a beam meets: the neighbouring beam goes through, so the
// echo is put outside of the neighbour's cone.
TEST(ObstacleMemory, NeighboursNarrowTheArc) {
  ObstacleMemory memory;
  memory.move_to(kOrigin);
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
  EXPECT_GT(nearest(memory, {std::cos(radians(-11)), std::sin(radians(-11))}), 0.06);
}

TEST(ObstacleMemory, WhatWasTouchedIsAnObstacleUntilBeamsFindItsPlaceEmpty) {
  ObstacleMemory memory;
  memory.move_to({});
  memory.touch({0.3, 0.0});
  memory.collect({});
  ASSERT_FALSE(memory.points().empty());
  for (const Vec2& point : memory.points())
    EXPECT_LT((point - Vec2(0.3, 0.0)).norm(), 0.1 + 1e-9);
  for (int i = 0; i < 12; ++i)
    memory.echo(kOrigin, 2.0);
  memory.collect({});
  EXPECT_GT(nearest(memory, {0.35, 0.0}), 0.06) << "the beam passes here";
}

}  // namespace
}  // namespace saphira::lps
