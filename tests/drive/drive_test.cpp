#include "drive/drive.hpp"

#include <gtest/gtest.h>

namespace saphira::test {
namespace {

/// Drives round a corner of the corridors by the true pose; returns the last cycle.
Seen tour(std::uint64_t seed, int& contacts) {
  DriveOptions options;
  options.seed = seed;
  Drive drive(options);
  Tour tour({{17.5, 8.0}, {19.0, 7.0}, {25.6, 7.0}}, false);
  while (tour.act(drive, drive.seen().true_pose_in_world) && drive.seen().cycle < 1500)
    drive.advance();
  contacts = drive.contacts();
  EXPECT_EQ(tour.reached(), 3U);
  return drive.seen();
}

TEST(Drive, GetsRoundACornerWithoutContactAndTheSameEachTime) {
  int contacts = 0;
  const Seen a = tour(1, contacts);
  EXPECT_EQ(contacts, 0);
  const Seen b = tour(1, contacts);
  EXPECT_EQ(a.true_pose_in_world, b.true_pose_in_world);
  EXPECT_EQ(a.pose_in_odom, b.pose_in_odom);
  EXPECT_NE(a.true_pose_in_world, tour(2, contacts).true_pose_in_world);
}

}  // namespace
}  // namespace saphira::test
