#include "synthetic.hpp"

#include <gtest/gtest.h>

#include "saphira/logs/metrics.hpp"
#include "saphira/logs/scan_mapping.hpp"

namespace saphira::bench {

using namespace logs;
namespace {

double error_of(const DataSet& set) {
  logs::ScanMapper mapper;
  for (std::size_t i = 0; i < set.scans.size(); ++i)
    mapper.add(set.poses_in_odom[i], set.scans[i]);
  mapper.refine(2);
  std::vector<StampedPose> poses;
  const std::vector<Pose> found = mapper.trajectory();
  for (std::size_t i = 0; i < found.size(); ++i)
    poses.push_back({set.times[i], found[i]});
  return ate_rmse(pair_up(Trajectory(poses), *set.reference));
}

TEST(Synthetic, TheSameSeedIsTheSameDrive) {
  const DataSet first = synthetic_data_set("office-thinned", 1);
  const DataSet again = synthetic_data_set("office-thinned", 1);
  EXPECT_EQ(first.poses_in_odom, again.poses_in_odom);
  ASSERT_EQ(first.scans.size(), again.scans.size());
  EXPECT_EQ(first.scans.back().points, again.scans.back().points);
  EXPECT_NE(first.poses_in_odom, synthetic_data_set("office-thinned", 2).poses_in_odom);
  EXPECT_GT(ate_rmse(pair_up(first.odometry, *first.reference)), 1.0);
}

TEST(Synthetic, AThinnedLogOfAnOfficeIsEnough) {
  EXPECT_LT(error_of(synthetic_data_set("office-thinned", 1)), 0.03);
}

TEST(Synthetic, RoomsThatLookAlikeAreNotTakenForOneAnother) {
  EXPECT_LT(error_of(synthetic_data_set("rows-thinned-slipping", 1)), 0.15);
}

}  // namespace
}  // namespace saphira::bench
