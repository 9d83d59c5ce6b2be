#include "saphira/logs/log_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "saphira/logs/virtual_sonar.hpp"
#include "scan_room.hpp"

namespace saphira::logs {
namespace {

/// A room of 8 by 6 m with a partition.
const std::vector<test::Piece> kRoom{
    {{0, 0}, {8, 0}}, {{8, 0}, {8, 6}}, {{8, 6}, {0, 6}}, {{0, 6}, {0, 0}}, {{4, 0}, {4, 2.5}}};

struct Round {
  DataSet log;
  Trajectory truth{{}};
};

/// Twice round the room, with dead reckoning that turns too much.
Round drive_round() {
  DataSet log;
  log.name = "room";
  Random random(1);
  Pose truth{2.0, 3.5, 0.0};
  Pose odom;
  std::vector<StampedPose> odometry;
  std::vector<StampedPose> reference;
  Beams beams;
  for (int i = 0; i < 500; ++i) {
    const Pose step{0.05, 0.0, 0.05 / 1.6};
    truth = compose(truth, step);
    odom = compose(odom, {step.x * random.normal(1.0, 0.02), 0.0, step.th + radians(0.1)});
    const double time = 0.2 * i;
    odometry.push_back({time, odom});
    reference.push_back({time, truth});
    std::vector<double> ranges;
    for (int beam = 0; beam <= 180; ++beam)
      ranges.push_back(test::range_to(truth.position(),
                                      truth.th + beams.first_angle + beam * beams.step, kRoom) +
                       random.normal(0.0, 0.005));
    log.times.push_back(time);
    log.poses_in_odom.push_back(odom);
    log.scans.push_back(make_scan(ranges, beams));
  }
  log.odometry = Trajectory(odometry);
  return {log, Trajectory(reference)};
}

TEST(LogMap, WallsAndPosesComeFromTheScans) {
  const auto [log, truth] = drive_round();
  const LogMap mapped = map_log(log);
  ASSERT_EQ(mapped.poses.size(), log.scans.size());
  const Accuracy reckoned = accuracy(log.odometry.poses(), truth);
  const Accuracy by_laser = accuracy(mapped.poses, truth);
  EXPECT_GT(reckoned.ate, 0.2);
  EXPECT_LT(by_laser.ate, 0.03);
  EXPECT_EQ(by_laser.compared, log.scans.size());
  double longest = 0.0;
  for (const maps::Feature& wall : mapped.walls.features) {
    EXPECT_EQ(wall.type, lps::PointType::wall);
    longest = std::max(longest, wall.length);
  }
  EXPECT_GE(mapped.walls.features.size(), 5U);
  EXPECT_NEAR(longest, 8.0, 0.5);
}

TEST(LogMap, SonarsHoldThePoseOnTheMapOfTheLog) {
  const DataSet log = drive_round().log;
  const LogMap mapped = map_log(log);
  const LogEvaluation result =
      evaluate_log(log, mapped, front_of_b21(), mapped.walls, mapped.poses.front().pose);
  EXPECT_EQ(result.run.unplaced, 0U);
  EXPECT_GT(result.run.tracked.size(), result.run.steps * 9 / 10);
  EXPECT_EQ(result.tracked.compared, result.run.tracked.size());
  EXPECT_LT(result.localized.ate, 0.5 * result.dead_reckoning.ate);
}

TEST(LogMap, WhatHasNoScanOrIsInterruptedIsSaid) {
  DataSet log;
  log.name = "nothing";
  EXPECT_THROW(map_log(log), std::runtime_error);
  int asked = 0;
  EXPECT_THROW(map_log(drive_round().log, [&] { return ++asked < 3; }), std::runtime_error);
  EXPECT_EQ(asked, 3);
}

}  // namespace
}  // namespace saphira::logs
