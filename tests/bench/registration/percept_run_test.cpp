#include "percept_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace saphira::bench {

using namespace logs;
namespace {

// A corridor along x with walls at y = 1 and -1; the left one is open from 4.0 to 4.9.
std::vector<logs::Scan> along_a_corridor(const std::vector<Pose>& poses) {
  std::vector<logs::Scan> scans;
  for (const Pose& pose : poses) {
    std::vector<double> ranges;
    logs::Beams beams;
    for (int i = 0; i <= 180; ++i) {
      const double at = beams.first_angle + i * beams.step;
      const double range = 1.0 / std::max(1e-3, std::abs(std::sin(at)));
      const double x = pose.x + range * std::cos(at);
      ranges.push_back(at > 0.0 && x > 4.0 && x < 4.9 ? 2.5 * range : range);
    }
    scans.push_back(logs::make_scan(ranges, beams));
  }
  return scans;
}

TEST(Percepts, AreHeldAgainstAReferenceAndTheLaser) {
  SonarDrive drive;
  drive.ring.mounts = front_of_b21();
  drive.at_once = true;
  for (int i = 0; i < 80; ++i) {
    drive.times.push_back(0.4 * i);
    drive.poses_in_odom.push_back({0.1 * i, 0.0, 0.0});
  }
  const auto scans = along_a_corridor(drive.poses_in_odom);
  for (const auto& scan : scans)
    drive.readings.push_back(hear(scan, drive.ring));
  const LaserCells cells(scans, drive.poses_in_odom);
  EXPECT_TRUE(cells.near({2.0, 1.0}, 0.06));
  EXPECT_TRUE(cells.free({2.0, 0.0}));
  EXPECT_FALSE(cells.sees({2.0, 0.0}, {2.0, 2.0}));
  EXPECT_TRUE(cells.sees({4.5, 0.0}, {4.5, 2.0}));

  const maps::Map reference = maps::parse_map(
      "WALL 2000, 1000, 0, 4000\nWALL 8450, 1000, 0, 7100\nWALL 6000, -1000, 0, 12000\n"
      "DOOR (1) 4450, 1000, -90, 900\nOFFICE (2) 6000, 0, 0, 12000, 3000 \"covered\"\n",
      "reference.map");
  EXPECT_GT(agreement(reference, cells), 0.9);
  const PerceptRun run = run_percepts(drive, drive.poses_in_odom, reference, cells);
  ASSERT_TRUE(run.by_hand);
  EXPECT_EQ(run.by_hand->doors_passed(), 1);
  EXPECT_EQ(run.by_hand->doors_found(), 1);
  EXPECT_GT(run.by_hand->walls().reported, 1);
  EXPECT_EQ(run.by_hand->walls().real, run.by_hand->walls().reported);
  EXPECT_EQ(run.by_laser.walls().real, run.by_laser.walls().reported);
  EXPECT_EQ(run.by_laser.doors().real, 1);

  // The same percepts half a metre aside match nothing.
  std::vector<Pose> aside;
  for (const Pose& pose : drive.poses_in_odom)
    aside.push_back({pose.x, 0.5, 0.0});
  const PerceptRun wrong = run_percepts(drive, aside, reference, cells);
  EXPECT_EQ(wrong.by_hand->walls().real, 0);
  EXPECT_EQ(wrong.by_hand->doors_found(), 0);
  EXPECT_EQ(wrong.by_laser.walls().real, 0);

  const auto [muriel, cone] = run_grids(drive, drive.poses_in_odom, reference, cells);
  EXPECT_GT(muriel.walls, 0.7);
  EXPECT_LT(muriel.free, 0.02);
  EXPECT_GT(muriel.auc, 0.8);
  EXPECT_GT(cone.auc, 0.5);
}

}  // namespace
}  // namespace saphira::bench
