#include <gtest/gtest.h>

#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/lps/point.hpp"

namespace saphira::lps {
namespace {

void expect_near(const Pose& a, const Pose& b) {
  EXPECT_NEAR(a.x, b.x, 1e-9);
  EXPECT_NEAR(a.y, b.y, 1e-9);
  EXPECT_NEAR(norm2_angle(a.th - b.th), 0.0, 1e-9);
}

TEST(Artifact, StaysInItsPlaceAsTheRobotMoves) {
  LocalPerceptualSpace lps;
  lps.update({1.0, 1.0, 0.0}, {}, 1);
  const std::uint32_t id = lps.add(lps.local_point({1.0, 0.0, 0.0}));
  expect_near(lps.find(id)->global, {2.0, 1.0, 0.0});
  lps.update({2.0, 2.0, kPi / 2}, {}, 2);
  expect_near(lps.find(id)->global, {2.0, 1.0, 0.0});
  expect_near(lps.find(id)->local, {-1.0, 0.0, -kPi / 2});
}

TEST(Artifact, LocalAndGlobalCoordinatesFollowEachOther) {
  LocalPerceptualSpace lps;
  lps.update({0.0, 0.0, kPi / 2}, {}, 1);
  Artifact point = lps.global_point({0.0, 3.0, 0.0});
  expect_near(point.local, {3.0, 0.0, -kPi / 2});
  point.local = {1.0, 0.0, 0.0};
  lps.set_global(point);
  expect_near(point.global, {0.0, 1.0, kPi / 2});
  EXPECT_EQ(point.type, PointType::position);
}

TEST(Artifact, IsInTheListOnce) {
  LocalPerceptualSpace lps;
  const std::uint32_t id = lps.add(lps.local_point({1.0, 0.0, 0.0}));
  Artifact again = *lps.find(id);
  again.width = 2.0;
  EXPECT_EQ(lps.add(again), id);
  EXPECT_EQ(lps.artifacts().size(), 2U);  // with the global origin
  EXPECT_EQ(lps.find(id)->width, 2.0);
  EXPECT_TRUE(lps.remove(id));
  EXPECT_FALSE(lps.remove(id));
  EXPECT_EQ(lps.find(id), nullptr);
}

TEST(Artifact, TheGlobalOriginIsAlwaysThere) {
  LocalPerceptualSpace lps;
  lps.update({2.0, 0.0, 0.0}, {}, 1);
  const Artifact& origin = lps.artifacts().front();
  expect_near(origin.local, {-2.0, 0.0, 0.0});
  EXPECT_FALSE(lps.remove(origin.id));
}

TEST(MoveRobot, MovesItInTheGlobalFrame) {
  LpsSettings settings;
  settings.sonars = {{0, {}}};
  LocalPerceptualSpace lps(settings);
  lps.update({5.0, 0.0, kPi / 2}, {{0, 1.0, true}}, 1);
  const std::uint32_t id = lps.add(lps.local_point({2.0, 0.0, 0.0}));
  lps.move_robot(1.0, 0.0, 0.0);
  expect_near(lps.robot_in_global(), {5.0, 1.0, kPi / 2});
  expect_near(lps.find(id)->local, {1.0, 0.0, 0.0});
  // Odometry and the readings, which are relative to the robot, are not affected.
  expect_near(lps.robot_in_odom(), {5.0, 0.0, kPi / 2});
  EXPECT_NEAR(lps.front().entries()[0].in_robot.x(), 1.0, 1e-12);
  // It lasts.
  lps.update({5.0, 0.5, kPi / 2}, {}, 2);
  expect_near(lps.robot_in_global(), {5.0, 1.5, kPi / 2});
  expect_near(lps.find(id)->local, {0.5, 0.0, 0.0});
}

TEST(Lps, ResetForgets) {
  LpsSettings settings;
  settings.sonars = {{0, {}}};
  LocalPerceptualSpace lps(settings);
  lps.update({5.0, 0.0, 0.0}, {{0, 1.0, true}}, 7);
  lps.add(lps.local_point({2.0, 0.0, 0.0}));
  lps.reset();
  EXPECT_EQ(lps.artifacts().size(), 1U);
  EXPECT_TRUE(lps.front().entries().empty());
  EXPECT_TRUE(lps.obstacles().empty());
  lps.update({1.0, 0.0, 0.0}, {}, 1);
  expect_near(lps.robot_in_global(), {1.0, 0.0, 0.0});
}

}  // namespace
}  // namespace saphira::lps
