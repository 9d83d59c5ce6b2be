#include <gtest/gtest.h>

#include "perception/score.hpp"

namespace saphira::test {
namespace {

TEST(Perception, WhatIsReportedInTheOfficeFloorIsThere) {
  Count walls;
  Count doors;
  int passed = 0;
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    DriveOptions options;
    options.seed = seed;
    options.errors = 2.0;
    Drive drive(options);
    interpretation::Interpretation interpretation(settings_of(drive));
    Score score(drive, map_of("office-floor"));
    Tour tour(patrol("office-floor"), true);
    while (drive.seen().cycle < 6000) {
      tour.act(drive, drive.seen().true_pose_in_world);
      const Seen& seen = drive.advance();
      score.look(drive, interpretation.step({seen.cycle, seen.pose_in_odom, seen.readings, {}}));
    }
    walls.reported += score.walls().reported;
    walls.real += score.walls().real;
    doors.reported += score.doors().reported;
    doors.real += score.doors().real;
    passed += score.doors_passed();
    found += score.doors_found();
  }
  EXPECT_GT(walls.reported, 60);
  EXPECT_GT(doors.reported, 60);
  EXPECT_GE(walls.precision(), 0.98);
  EXPECT_GE(doors.precision(), 0.98);
  EXPECT_GT(passed, 60);
  EXPECT_GE(found, 0.8 * passed);
}

}  // namespace
}  // namespace saphira::test
