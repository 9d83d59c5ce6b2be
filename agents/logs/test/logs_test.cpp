#include <gtest/gtest.h>

#include <cmath>

#include "saphira/base/text.hpp"
#include "saphira/logs/carmen.hpp"
#include "saphira/logs/laser_map.hpp"
#include "saphira/logs/metrics.hpp"
#include "saphira/logs/virtual_sonar.hpp"

namespace saphira::logs {
namespace {

TEST(Carmen, ScansAndDeadReckoningAreRead) {
  const CarmenLog log = parse_carmen(
      "# CARMEN Logfile\n"
      "PARAM robot_length 0.47 nohost 0\n"
      "ODOM 1 2 0.5 0 0 0 10.5 host 0.5\n"
      "FLASER 3 1.5 81.9 2.5 1.1 2 0.5 1 2 0.5 10.6 host 0.6\n",
      "a.log");
  ASSERT_EQ(log.odometry.size(), 1U);
  EXPECT_DOUBLE_EQ(log.odometry[0].time.ipc, 10.5);
  EXPECT_DOUBLE_EQ(log.odometry[0].time.logger, 0.5);
  ASSERT_EQ(log.scans.size(), 1U);
  EXPECT_EQ(log.scans[0].ranges, (std::vector<double>{1.5, 81.9, 2.5}));
  EXPECT_EQ(log.scans[0].pose, (Pose{1.0, 2.0, 0.5}));
  EXPECT_NEAR(log.scans[0].laser_in_robot.x, 0.1 * std::cos(0.5), 1e-12);
  EXPECT_DOUBLE_EQ(log.scans[0].step, kPi / 2);
  EXPECT_TRUE(log.damaged.empty());
}

TEST(Carmen, NewLaserMessagesSayWhatTheLaserIs) {
  const CarmenLog log = parse_carmen(
      "ROBOTLASER1 4 -0.00435 0.0087 0.0087 30 0.01 0 2 1.25 nan 0 1 2 0 1 2 0 0.1 0.2 0.3 "
      "0.4 0.5 10.7 host 0.7\r\n",
      "a.log");
  ASSERT_EQ(log.scans.size(), 1U);
  EXPECT_DOUBLE_EQ(log.scans[0].step, 0.0087);
  EXPECT_DOUBLE_EQ(log.scans[0].no_return, 29.99);
  EXPECT_GT(log.scans[0].ranges[1], log.scans[0].no_return);
  EXPECT_DOUBLE_EQ(log.scans[0].time.ipc, 10.7);
  EXPECT_TRUE(log.damaged.empty());
}

TEST(Carmen, ADamagedLineIsNamedAndPassedOver) {
  const CarmenLog log = parse_carmen(
      "FLASER 2 1 1 0 0 0 0 0 0 1 h 1\nFLASER 2 1 x 0 0 0 0 0 0 2 h 2\nFLASER 5 1 1\n", "a.log");
  EXPECT_EQ(log.scans.size(), 1U);
  ASSERT_EQ(log.damaged.size(), 2U);
  EXPECT_TRUE(log.damaged[0].starts_with("a.log:2:12: expected a range")) << log.damaged[0];
  EXPECT_TRUE(log.damaged[1].starts_with("a.log:3:13:")) << log.damaged[1];
  EXPECT_THROW(parse_carmen("ODOM 0 0 0 0 0 0 1 h 1\n", "a.log"), FileError);
  EXPECT_THROW(read_log("/nowhere/a.log"), std::runtime_error);
}

// A way of 30 m in arcs.
std::vector<StampedPose> a_way() {
  std::vector<StampedPose> way;
  Pose pose;
  for (int i = 0; i < 300; ++i) {
    way.push_back({0.1 * i, pose});
    pose = compose(pose, {0.1, 0.0, 0.03 * std::sin(0.05 * i)});
  }
  return way;
}

TEST(Metrics, AlignmentTakesAwayTheFrameAndNothingElse) {
  const auto way = a_way();
  std::vector<StampedPose> moved;
  for (std::size_t i = 0; i < way.size(); ++i) {
    // To the left and to the right in turn, by 0.1 m.
    const Pose aside = compose(way[i].pose, {0.0, i % 2 == 0 ? 0.1 : -0.1, 0.0});
    moved.push_back({way[i].time, compose({5.0, -3.0, 2.0}, aside)});
  }
  const Pairs pairs = pair_up(Trajectory(moved), Trajectory(way));
  ASSERT_EQ(pairs.estimate.size(), way.size());
  EXPECT_NEAR(ate_rmse(pairs), 0.1, 1e-3);
  EXPECT_NEAR(norm2_angle(alignment(pairs).th + 2.0), 0.0, 1e-3);
}

TEST(Metrics, DriftIsPerDistance) {
  const auto way = a_way();
  std::vector<StampedPose> drifting;
  Pose pose;
  for (std::size_t i = 0; i < way.size(); ++i) {
    drifting.push_back({way[i].time, pose});
    if (i + 1 < way.size()) {
      Pose step = relative(way[i].pose, way[i + 1].pose);
      step.th += radians(0.1);  // 1 degree per metre
      pose = compose(pose, step);
    }
  }
  const auto errors = drift(pair_up(Trajectory(drifting), Trajectory(way)), 10.0);
  EXPECT_NEAR(degrees(errors.rotation), 10.0, 0.2);
}

Scan before_a_wall(double angle) {
  // A wall 2 m away, its normal turned by `angle` from the axis.
  Scan scan;
  for (double t = -1.0; t <= 1.0; t += 0.01) {
    scan.points.emplace_back(2.0 - t * std::sin(angle), t * std::cos(angle));
    scan.normals.emplace_back(-std::cos(angle), -std::sin(angle));
  }
  return scan;
}

TEST(VirtualSonar, HearsWhatDoesNotMirrorItsSoundAway) {
  SonarRing ring;
  ring.mounts = {{3, {0.1, 0.0, 0.0}}, {4, {0.1, 0.0, kPi / 2}}};
  const auto head_on = hear(before_a_wall(0.0), ring);
  ASSERT_EQ(head_on.size(), 2U);
  EXPECT_EQ(head_on[0].sonar, 3);
  EXPECT_TRUE(head_on[0].echo);
  EXPECT_NEAR(head_on[0].range, 1.9, 1e-3);
  EXPECT_FALSE(head_on[1].echo);
  EXPECT_FALSE(hear(before_a_wall(radians(50.0)), ring)[0].echo);
}

TEST(LaserMap, DrawsTheWallsThatWereScanned) {
  // A room of 4 by 3 m, from three places.
  std::vector<Scan> scans;
  const std::vector<Pose> poses{
      {1.0, 1.0, 0.0}, {2.0, 1.5, 2.0}, {3.0, 2.0, -2.0}, {2.0, 1.0, 1.0}};
  for (const Pose& pose : poses) {
    std::vector<double> ranges;
    Beams beams;
    beams.first_angle = -kPi;
    for (int i = 0; i < 360; ++i) {
      const double at = pose.th + beams.first_angle + i * beams.step;
      const double to_x = (std::cos(at) > 0 ? 4.0 - pose.x : -pose.x) / std::cos(at);
      const double to_y = (std::sin(at) > 0 ? 3.0 - pose.y : -pose.y) / std::sin(at);
      ranges.push_back(std::min(to_x, to_y));
    }
    scans.push_back(make_scan(ranges, beams));
  }
  const maps::Map map = walls_of(scans, poses);
  ASSERT_EQ(map.features.size(), 4U);
  double length = 0.0;
  for (const maps::Feature& wall : map.features) {
    EXPECT_EQ(wall.type, lps::PointType::wall);
    length += wall.length;
    const Pose& p = wall.pose_in_map;
    EXPECT_LT(std::min({std::abs(p.x), std::abs(p.x - 4.0), std::abs(p.y), std::abs(p.y - 3.0)}),
              0.03);
  }
  EXPECT_NEAR(length, 13.0, 1.5);
}

}  // namespace
}  // namespace saphira::logs
