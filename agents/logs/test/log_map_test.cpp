#include "saphira/logs/log_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "scan_room.hpp"

namespace saphira::logs {
namespace {

/// A room of 8 by 6 m with a partition.
const std::vector<test::Piece> kRoom{
    {{0, 0}, {8, 0}}, {{8, 0}, {8, 6}}, {{8, 6}, {0, 6}}, {{0, 6}, {0, 0}}, {{4, 0}, {4, 2.5}}};

struct Round {
  DataSet log;
  std::vector<Pose> truth;
};

/// [m] the largest distance from the truth, as seen from the first pose.
double worst(const std::vector<Pose>& poses, const std::vector<Pose>& truth) {
  double most = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    most = std::max(most, (relative(poses.front(), poses[i]).position() -
                           relative(truth.front(), truth[i]).position())
                              .norm());
  return most;
}

/// Twice round the room, with dead reckoning that turns too much.
Round drive_round() {
  DataSet log;
  log.name = "room";
  Random random(1);
  Pose truth{2.0, 3.5, 0.0};
  Pose odom;
  std::vector<Pose> reference;
  Beams beams;
  for (int i = 0; i < 500; ++i) {
    const Pose step{0.05, 0.0, 0.05 / 1.6};
    truth = compose(truth, step);
    odom = compose(odom, {step.x * random.normal(1.0, 0.02), 0.0, step.th + radians(0.1)});
    reference.push_back(truth);
    std::vector<double> ranges;
    for (int beam = 0; beam <= 180; ++beam)
      ranges.push_back(test::range_to(truth.position(),
                                      truth.th + beams.first_angle + beam * beams.step, kRoom) +
                       random.normal(0.0, 0.005));
    log.times.push_back(0.2 * i);
    log.poses_in_odom.push_back(odom);
    log.scans.push_back(make_scan(ranges, beams));
  }
  return {log, reference};
}

TEST(LogMap, WallsAndPosesComeFromTheScans) {
  const auto [log, truth] = drive_round();
  const LogMap mapped = map_log(log);
  ASSERT_EQ(mapped.poses.size(), log.scans.size());
  EXPECT_GT(worst(log.poses_in_odom, truth), 0.4);
  EXPECT_LT(worst(mapped.poses, truth), 0.15);
  double longest = 0.0;
  for (const maps::Feature& wall : mapped.walls.features) {
    EXPECT_EQ(wall.type, lps::PointType::wall);
    longest = std::max(longest, wall.length);
  }
  EXPECT_GE(mapped.walls.features.size(), 5U);
  EXPECT_NEAR(longest, 8.0, 0.5);
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
