#include "saphira/registration/matching.hpp"

#include <gtest/gtest.h>

namespace saphira::registration {
namespace {

using lps::PointType;

const maps::Map kMap = maps::parse_map(
    "CORRIDOR (1) 10000, 0, 0, 20000, 2000\n"
    "DOOR (2) 3000, 1000, -90, 900\n"
    "DOOR (3) 4200, 1000, -90, 900\n"
    "DOOR (4) 9000, -1000, 90, 900\n",
    "test");

PoseFilter filter_at(const Pose& pose, double sigma) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.diagonal() << sigma * sigma, sigma * sigma, 0.05 * 0.05;
  return {pose, covariance, 0.0, 1e-6, {}};
}

/// Seen by a robot whose odom is the map.
lps::Percept percept(PointType type, const Pose& pose, double length, double width) {
  lps::Percept result;
  result.id = 7;
  result.type = type;
  result.pose_in_odom = pose;
  result.length = length;
  result.width = width;
  result.sigma_along = 0.03;
  result.sigma_across = 0.03;
  result.sigma_heading = radians(1.0);
  result.confidence = 1.0;
  return result;
}

TEST(Matching, AWallCorrectsAcrossAndTheHeadingOnly) {
  const LineMap lines(kMap);
  PoseFilter filter = filter_at({6.0, 0.2, radians(4.0)}, 0.2);
  // In truth the robot is at (6, 0, 0); it sees the left wall a metre off.
  const Match result = match(percept(PointType::wall, {6.0, 1.0, 0.0}, 1.5, 0.0), {6.0, 0.0, 0.0},
                             kMap, lines, {}, filter);
  EXPECT_TRUE(result.accepted) << result.reason;
  EXPECT_EQ(result.artifact, 1U);
  EXPECT_NEAR(filter.pose().y, 0.0, 0.03);
  EXPECT_NEAR(filter.pose().th, 0.0, radians(1.0));
  EXPECT_NEAR(filter.pose().x, 6.0, 0.02);
  EXPECT_GT(std::sqrt(filter.covariance()(0, 0)), 0.19);
}

TEST(Matching, ADoorCorrectsAlongTheWall) {
  const LineMap lines(kMap);
  PoseFilter filter = filter_at({9.3, 0.1, 0.0}, 0.2);
  const Match result = match(percept(PointType::door, {9.0, -1.0, kPi / 2}, 0.0, 0.95),
                             {9.0, 0.0, 0.0}, kMap, lines, {}, filter);
  EXPECT_TRUE(result.accepted) << result.reason;
  EXPECT_EQ(result.artifact, 4U);
  EXPECT_NEAR(filter.pose().x, 9.0, 0.03);
}

TEST(Matching, ADoorThatCouldBeTwoIsLeftAlone) {
  const LineMap lines(kMap);
  PoseFilter filter = filter_at({3.5, 0.0, 0.0}, 0.5);
  const Match result = match(percept(PointType::door, {3.0, 1.0, -kPi / 2}, 0.0, 0.9),
                             {3.0, 0.0, 0.0}, kMap, lines, {}, filter);
  EXPECT_FALSE(result.accepted);
  EXPECT_TRUE(result.ambiguous);
  EXPECT_EQ(filter.pose(), (Pose{3.5, 0.0, 0.0}));
  // A robot with a certain pose takes the nearer one.
  PoseFilter sure = filter_at({3.1, 0.0, 0.0}, 0.1);
  EXPECT_TRUE(match(percept(PointType::door, {3.0, 1.0, -kPi / 2}, 0.0, 0.9), {3.0, 0.0, 0.0}, kMap,
                    lines, {}, sure)
                  .accepted);
}

TEST(Matching, WhatTheMapDoesNotHaveIsRefusedWithAReason) {
  const LineMap lines(kMap);
  PoseFilter filter = filter_at({14.0, 0.0, 0.0}, 0.1);
  const Match door = match(percept(PointType::door, {14.0, 1.0, -kPi / 2}, 0.0, 0.9),
                           {14.0, 0.0, 0.0}, kMap, lines, {}, filter);
  EXPECT_FALSE(door.accepted);
  EXPECT_EQ(door.reason, "nothing of the kind is near");
  const Match cupboard = match(percept(PointType::wall, {14.0, 0.55, 0.0}, 1.0, 0.0),
                               {14.0, 0.0, 0.0}, kMap, lines, {}, filter);
  EXPECT_FALSE(cupboard.accepted);
  EXPECT_EQ(cupboard.reason, "too far from where the nearest is expected");
  EXPECT_EQ(filter.pose(), (Pose{14.0, 0.0, 0.0}));
  // A door that opens to the other side is another door.
  const Match back = match(percept(PointType::door, {9.0, -1.0, -kPi / 2}, 0.0, 0.9),
                           {9.0, 0.0, 0.0}, kMap, lines, {}, filter);
  EXPECT_FALSE(back.accepted);
}

TEST(Matching, ACorridorCorrectsByItsMiddle) {
  const LineMap lines(kMap);
  PoseFilter filter = filter_at({6.0, 0.25, radians(3.0)}, 0.2);
  const Match result = match(percept(PointType::corridor, {5.0, 0.0, 0.0}, 3.0, 2.05),
                             {6.0, 0.0, 0.0}, kMap, lines, {}, filter);
  EXPECT_TRUE(result.accepted) << result.reason;
  EXPECT_NEAR(filter.pose().y, 0.0, 0.03);
  PoseFilter other = filter_at({6.0, 0.25, radians(3.0)}, 0.2);
  EXPECT_FALSE(match(percept(PointType::corridor, {5.0, 0.0, 0.0}, 3.0, 1.4), {6.0, 0.0, 0.0}, kMap,
                     lines, {}, other)
                   .accepted);
}

}  // namespace
}  // namespace saphira::registration
