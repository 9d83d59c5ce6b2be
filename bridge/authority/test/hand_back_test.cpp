// After a person has driven, autonomy waits until the robot is handed back.
#include <gtest/gtest.h>

#include "scene.hpp"

namespace saphira::authority {
namespace {

using test::Scene;
using test::writer;

/// A person has driven and lets go, while the behaviors ask to drive.
struct Driven : Scene {
  explicit Driven(Settings settings = {}) : Scene(settings) {
    offer(Role::teleop, 1);
    offer(Role::behaviors, 2);
    EXPECT_EQ(driver(), Role::teleop);
    EXPECT_FALSE(grant().waits_for_hand_back);
  }
  /// A cycle in which the behaviors ask to drive; returns the role that drives.
  Role next() {
    wait(1);
    offer(Role::behaviors, 2);
    return driver();
  }
};

TEST(HandBack, ADroppedJoystickNeverMakesTheRobotDriveOff) {
  Driven s;
  for (int i = 0; i < 10000; ++i) {
    const Role role = s.next();
    ASSERT_NE(role, Role::behaviors) << i;
  }
  const Grant grant = s.grant();
  EXPECT_TRUE(grant.waits_for_hand_back);
  EXPECT_NE(grant.reason.find("saphira drive hand-back"), std::string::npos);
}

TEST(HandBack, NorDoesADeadProgram) {
  Driven s;
  s.arbiter.lost(Role::teleop, writer(1), s.now);
  for (int i = 0; i < 1000; ++i)
    ASSERT_EQ(s.next(), Role::none) << i;
}

TEST(HandBack, NorAReleaseAlone) {
  Driven s;
  for (int i = 0; i < 1000; ++i) {
    s.offer(Role::teleop, 1, false);
    ASSERT_EQ(s.next(), Role::none) << i;
  }
}

TEST(HandBack, NorANewConnectionOrARestart) {
  Driven s;
  s.arbiter.connect(0);
  s.arbiter.connect(1);
  EXPECT_EQ(s.next(), Role::none);
  Scene after;
  after.arbiter.restore(latches_from_text(to_text(s.arbiter.latches())));
  after.offer(Role::behaviors, 2);
  EXPECT_EQ(after.driver(), Role::none);
  EXPECT_TRUE(after.grant().waits_for_hand_back);
}

TEST(HandBack, LetsAutonomyDriveOn) {
  Driven s;
  s.hand_back(1);
  EXPECT_EQ(s.next(), Role::behaviors);
  EXPECT_FALSE(s.grant().waits_for_hand_back);
}

TEST(HandBack, MayComeFromAnotherProgramOfAPerson) {
  Driven s;
  s.wait(4);
  s.hand_back(7);
  EXPECT_EQ(s.next(), Role::behaviors);
}

TEST(HandBack, ButNotWhileAnotherDrives) {
  Driven s;
  s.arbiter.take_refused();
  s.hand_back(7);
  EXPECT_EQ(s.arbiter.take_refused().at(0).reason, "cannot hand back what teleop1 drives");
  EXPECT_EQ(s.driver(), Role::teleop);
  s.wait(4);
  EXPECT_EQ(s.next(), Role::none);
}

TEST(HandBack, CountsOnlyFromAPersonAndForNow) {
  Driven s;
  s.wait(4);
  Command c = s.command(Role::direct, 3, false);
  c.hand_back = true;
  s.arbiter.offer(c, s.cycle);
  EXPECT_EQ(s.next(), Role::none) << "a program cannot hand the robot to itself";
  c = s.command(Role::teleop, 1, false);
  c.hand_back = true;
  c.cycle = s.cycle - 31;
  s.arbiter.offer(c, s.cycle);
  EXPECT_EQ(s.next(), Role::none) << "an old word";
  c = s.command(Role::teleop, 1, false);
  c.hand_back = true;
  c.epoch = 7;
  s.arbiter.offer(c, s.cycle);
  EXPECT_EQ(s.next(), Role::none) << "of another connection";
}

TEST(HandBack, ByOptionAQuietPersonHandsBack) {
  Settings settings;
  settings.quiet = 2.0;
  Driven s(settings);
  const double released = s.now;
  s.offer(Role::teleop, 1, false);
  while (s.now - released < 1.85) {
    ASSERT_EQ(s.next(), Role::none) << s.now - released;
    s.offer(Role::teleop, 1, false);
  }
  s.wait(1);
  s.offer(Role::teleop, 1, false);
  EXPECT_EQ(s.next(), Role::behaviors);
}

TEST(HandBack, TheQuietTimeCountsOnlyWhileThatProgramIsHeard) {
  Settings settings;
  settings.quiet = 2.0;
  Driven s(settings);
  s.offer(Role::teleop, 1, false);
  s.next();
  for (int i = 0; i < 100; ++i) {
    s.offer(Role::teleop, 5, false);  // another joystick, at rest
    ASSERT_EQ(s.next(), Role::none) << i;
  }
  // The program is back: its pause was no quiet time.
  const double back = s.now;
  while (s.now - back < 1.85) {
    s.offer(Role::teleop, 1, false);
    ASSERT_EQ(s.next(), Role::none) << s.now - back;
  }
  s.wait(1);
  s.offer(Role::teleop, 1, false);
  EXPECT_EQ(s.next(), Role::behaviors);
}

TEST(HandBack, NoQuietTimeFollowsAnEmergencyStop) {
  Settings settings;
  settings.quiet = 0.0;
  Scene s(settings);
  s.offer(Role::behaviors, 2);
  s.offer(Role::estop, 3);
  s.offer(Role::estop, 3, false);
  ASSERT_EQ(s.arbiter.reset("keyboard", s.now), "");
  for (int i = 0; i < 100; ++i) {
    s.offer(Role::teleop, 1, false);
    s.offer(Role::behaviors, 2);
    ASSERT_EQ(s.driver(), Role::none) << i;
    s.wait(1);
  }
}

}  // namespace
}  // namespace saphira::authority
