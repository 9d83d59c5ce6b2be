#include <gtest/gtest.h>

#include <cmath>

#include "saphira/base/text.hpp"
#include "saphira/logs/carmen.hpp"
#include "saphira/logs/laser_map.hpp"

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
