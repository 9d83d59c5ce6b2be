#include "saphira/teleop/key_drive.hpp"

#include <gtest/gtest.h>

namespace saphira::teleop {
namespace {

using Keys = std::vector<DriveKey>;

Keys keys_of(std::string input) {
  return take_keys(input);
}

TEST(TakeKeys, TheKeysOfTheManual) {
  EXPECT_EQ(keys_of("imjlk gc"),
            (Keys{DriveKey::faster, DriveKey::slower, DriveKey::left, DriveKey::right,
                  DriveKey::stop, DriveKey::stop, DriveKey::constant, DriveKey::avoidance}));
  EXPECT_EQ(keys_of("\x1b[A\x1b[B\x1b[D\x1bOC"),
            (Keys{DriveKey::faster, DriveKey::slower, DriveKey::left, DriveKey::right}));
  EXPECT_EQ(keys_of("q\x03"), (Keys{DriveKey::quit, DriveKey::quit}));
}

TEST(TakeKeys, OtherKeysDoNothing) {
  // F5 is ESC [ 1 5 ~; shift-up is ESC [ 1 ; 2 A; alt-x is ESC x.
  EXPECT_EQ(keys_of("xyz\x1b[15~\x1b[1;2A\x1bx7"), Keys{});
}

TEST(TakeKeys, ASequenceInTwoPiecesIsWaitedFor) {
  std::string input = "i\x1b";
  EXPECT_EQ(take_keys(input), Keys{DriveKey::faster});
  input += "[";
  EXPECT_EQ(take_keys(input), Keys{});
  input += "A";
  EXPECT_EQ(take_keys(input), Keys{DriveKey::faster});
  EXPECT_TRUE(input.empty());
}

TEST(KeyDrive, NothingIsDrivenWithoutAKey) {
  EXPECT_FALSE(KeyDrive().order(0.0).active);
}

TEST(KeyDrive, ATapDrivesForTheFirstHoldAndStops) {
  KeyDrive drive;
  drive.press(DriveKey::faster, 10.0);
  EXPECT_TRUE(drive.order(10.0).active);
  EXPECT_DOUBLE_EQ(drive.order(10.0).velocity, 0.05);
  EXPECT_TRUE(drive.order(10.7).active);
  const auto after = drive.order(10.9);
  EXPECT_FALSE(after.active);
  EXPECT_EQ(after.velocity, 0.0);
}

TEST(KeyDrive, AHeldKeyBridgesTheDelayBeforeItsFirstRepeat) {
  KeyDrive drive;
  drive.press(DriveKey::faster, 0.0);
  EXPECT_TRUE(drive.order(0.66).active);
  double now = 0.66;
  for (int i = 0; i < 70; ++i) {
    now += 0.033;
    drive.press(DriveKey::faster, now);
    EXPECT_TRUE(drive.order(now + 0.03).active);
  }
  EXPECT_DOUBLE_EQ(drive.order(now).velocity, 0.4);
}

TEST(KeyDrive, LettingGoOfAHeldKeyStopsSoon) {
  KeyDrive drive;
  drive.press(DriveKey::faster, 0.0);
  for (int i = 0; i <= 8; ++i)
    drive.press(DriveKey::keep, 0.5 + 0.05 * i);
  EXPECT_TRUE(drive.order(1.1).active);
  EXPECT_FALSE(drive.order(1.25).active);
}

TEST(KeyDrive, ToGoOnWithNothingDrivesNothing) {
  KeyDrive drive;
  drive.press(DriveKey::keep, 0.0);
  EXPECT_FALSE(drive.order(0.0).active);
  drive.press(DriveKey::faster, 0.1);
  drive.press(DriveKey::keep, 0.5);
  EXPECT_TRUE(drive.order(1.0).active);
  drive.press(DriveKey::keep, 5.0);
  EXPECT_FALSE(drive.order(5.0).active);
}

TEST(KeyDrive, AHeldKeyAcceleratesNoFasterThanTheRate) {
  KeyDrive drive;
  drive.press(DriveKey::faster, 0.0);
  for (int i = 1; i <= 30; ++i)
    drive.press(DriveKey::faster, 0.5 + i * 0.033);
  EXPECT_LT(drive.order(1.5).velocity, 0.05 + 0.05 + 0.2 * 1.0 + 0.01);
}

TEST(KeyDrive, TheRobotsLimitHolds) {
  KeyDrive drive;
  drive.set_max_velocity(0.12);
  for (int i = 0; i < 10; ++i)
    drive.press(DriveKey::faster, i * 0.5);
  EXPECT_DOUBLE_EQ(drive.order(4.6).velocity, 0.12);
  for (int i = 10; i < 30; ++i)
    drive.press(DriveKey::slower, i * 0.5);
  EXPECT_DOUBLE_EQ(drive.order(14.6).velocity, -0.12);
}

TEST(KeyDrive, EachTurnIsANewMove) {
  KeyDrive drive;
  drive.press(DriveKey::faster, 0.0);
  const auto straight = drive.order(0.0);
  EXPECT_EQ(straight.turn->by, 0.0);
  drive.press(DriveKey::left, 0.1);
  const auto left = drive.order(0.1);
  EXPECT_GT(left.turn->by, 0.0);
  EXPECT_NE(left.turn->move, straight.turn->move);
  EXPECT_DOUBLE_EQ(left.velocity, straight.velocity);
  drive.press(DriveKey::right, 0.2);
  EXPECT_LT(drive.order(0.2).turn->by, 0.0);
  EXPECT_NE(drive.order(0.2).turn->move, left.turn->move);
  drive.press(DriveKey::keep, 0.3);
  EXPECT_EQ(drive.order(0.3).turn->move, drive.order(0.2).turn->move);
}

TEST(KeyDrive, AfterAReleaseTheHeadingIsHeldAnew) {
  KeyDrive drive;
  drive.press(DriveKey::left, 0.0);
  const auto first = drive.order(0.0);
  EXPECT_FALSE(drive.order(5.0).active);
  drive.press(DriveKey::faster, 6.0);
  const auto second = drive.order(6.0);
  EXPECT_NE(second.turn->move, first.turn->move);
  EXPECT_EQ(second.turn->by, 0.0);
}

TEST(KeyDrive, KeysThatASlowLineBringsTogetherAreOneDrive) {
  KeyDrive drive;
  double velocity = 0.0;
  for (int burst = 0; burst < 10; ++burst) {
    for (int key = 0; key < 3; ++key)
      drive.press(DriveKey::faster, 0.5 * burst + 0.001 * key);
    for (int i = 1; i < 10; ++i)
      EXPECT_TRUE(drive.order(0.5 * burst + 0.05 * i).active) << burst;
    velocity = drive.order(0.5 * burst + 0.49).velocity;
  }
  EXPECT_GE(velocity, 0.3);
  EXPECT_FALSE(drive.order(4.5 + 0.002 + 0.81).active) << "let go";
}

TEST(KeyDrive, OnAGoodLineItStopsSoonAfterAKeyIsLetGo) {
  KeyDrive drive;
  drive.press(DriveKey::faster, 0.0);
  double now = 0.5;  // the first repeat comes late
  for (int i = 0; i < 30; ++i, now += 0.033)
    drive.press(DriveKey::faster, now);
  EXPECT_TRUE(drive.order(now - 0.033 + 0.29).active);
  EXPECT_FALSE(drive.order(now - 0.033 + 0.31).active);
}

TEST(KeyDrive, AllStopLetsGo) {
  KeyDrive drive;
  drive.press(DriveKey::faster, 0.0);
  drive.press(DriveKey::stop, 0.1);
  EXPECT_FALSE(drive.order(0.1).active);
}

TEST(KeyDrive, ReleaseIsAtOnce) {
  KeyDrive drive;
  drive.press(DriveKey::faster, 0.0);
  drive.release();
  EXPECT_FALSE(drive.order(0.0).active);
}

}  // namespace
}  // namespace saphira::teleop
