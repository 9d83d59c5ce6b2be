#include "saphira/teleop/control.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace saphira::teleop {
namespace {

constexpr Control::OperatorId kAnn = 1;
constexpr Control::OperatorId kBob = 2;

/// Two operators; one drives 20 times a second.
class ControlTest : public testing::Test {
 protected:
  ControlTest() {
    control.join(kAnn, "ann");
    control.join(kBob, "bob");
  }
  Control::Sample sample(bool active) {
    return {++number, now + device_ahead, active, active ? 0.2 : 0.0, 0.0, 100};
  }
  /// Samples for that time, each without delay. True where the robot moved at the end.
  bool samples(bool active, double duration) {
    for (const double end = now + duration; now < end; now += 0.05) {
      refused = control.drive(kAnn, sample(active), now);
      moves = control.order(now).active;
    }
    return moves;
  }
  /// Silence for that time. Returns the time until which the robot moved, from its beginning.
  double silence(double duration) {
    double moved = 0.0;
    const double begin = now;
    for (const double end = now + duration; now < end; now += 0.01)
      if (control.order(now).active)
        moved = now - begin;
    return moved;
  }
  void take_and_drive() {
    EXPECT_EQ(control.take(kAnn, false, now), "");
    samples(false, 0.2);
    EXPECT_TRUE(samples(true, 0.5));
  }

  Control control;
  double now = 1000.0;
  double device_ahead = -777.0;  ///< [s] of the operator's clock
  std::uint64_t number = 0;
  std::string refused;
  bool moves = false;
};

TEST_F(ControlTest, DrivesWhatTheHolderHolds) {
  take_and_drive();
  const Order order = control.order(now);
  EXPECT_EQ(order.source, "ann");
  EXPECT_DOUBLE_EQ(order.velocity, 0.2);
  EXPECT_EQ(order.cycle, 100U);
  EXPECT_FALSE(samples(false, 0.05));  // at once
}

TEST_F(ControlTest, AStickThatIsHeldWhenControlIsTakenMovesNothing) {
  EXPECT_EQ(control.take(kAnn, false, now), "");
  EXPECT_FALSE(samples(true, 1.0));
  EXPECT_EQ(refused, "it was held already when control came");
  EXPECT_EQ(control.state().let_go, refused);
  samples(false, 0.1);
  EXPECT_EQ(control.state().let_go, "");
  EXPECT_TRUE(samples(true, 0.1));
}

TEST_F(ControlTest, AReleaseThatThePressHasOvertakenCounts) {
  EXPECT_EQ(control.take(kAnn, false, now), "");
  const Control::Sample release = sample(false);
  EXPECT_FALSE(samples(true, 0.2));
  EXPECT_EQ(control.drive(kAnn, release, now), "a repeated sample");
  EXPECT_TRUE(samples(true, 0.1));

  // Not one from before a gap, nor one that comes late.
  const Control::Sample before = sample(false);
  EXPECT_TRUE(samples(true, 0.1));
  now += 0.5;
  const Control::Sample late = sample(false);
  now += 0.1;
  EXPECT_FALSE(samples(true, 0.2));
  control.drive(kAnn, before, now);
  EXPECT_FALSE(samples(true, 0.2));
  now += 0.05;
  control.drive(kAnn, late, now);
  EXPECT_FALSE(samples(true, 0.2));
}

TEST_F(ControlTest, SilenceStopsWithinHalfASecondAndTheStickMustBeLetGo) {
  take_and_drive();
  EXPECT_LE(silence(0.6), 0.5);
  EXPECT_EQ(control.holder(), kAnn);
  EXPECT_FALSE(samples(true, 0.5));
  EXPECT_EQ(refused, "the picture came too late, so the robot stopped");
  EXPECT_EQ(control.state().let_go, refused);
  samples(false, 0.1);
  EXPECT_TRUE(samples(true, 0.1));
}

TEST_F(ControlTest, AfterALongSilenceTheOperatorOnlyWatches) {
  take_and_drive();
  EXPECT_LE(silence(2.0), 0.5);
  EXPECT_EQ(control.holder(), 0U);
  EXPECT_FALSE(samples(true, 0.5));
  EXPECT_EQ(refused, "you do not have control");
  EXPECT_EQ(control.state().note.find("nothing was heard of ann"), 0U);
}

// A retransmission delays all later samples: a third of a second is no reason to stop.
TEST_F(ControlTest, ASampleAfterALongSilenceDoesNotKeepControl) {
  take_and_drive();
  now += 1.1;  // nobody called order(): this program hung, too
  EXPECT_EQ(control.drive(kAnn, sample(false), now), "you do not have control");
  EXPECT_EQ(control.holder(), 0U);
}

TEST_F(ControlTest, AShortGapOfTheLinkGoesUnnoticed) {
  take_and_drive();
  EXPECT_GT(silence(0.3), 0.25);
  EXPECT_TRUE(samples(true, 0.1));
}

TEST_F(ControlTest, WhatWaitedInTheNetworkDrivesNothing) {
  take_and_drive();
  std::vector<Control::Sample> waiting;
  for (int i = 0; i < 20; ++i, now += 0.05)
    waiting.push_back(sample(true));
  // All of them at once, a second later: the newest is young, but the stick must be let go.
  for (const Control::Sample& one : waiting)
    control.drive(kAnn, one, now);
  EXPECT_FALSE(control.order(now).active);
}

TEST_F(ControlTest, ALinkThatGetsSlowStopsTheRobot) {
  take_and_drive();
  for (int i = 0; i < 20; ++i, now += 0.05) {
    Control::Sample late = sample(true);
    late.device_time -= 0.6;
    if (i > 0)
      EXPECT_NE(control.drive(kAnn, late, now), "");
    else
      control.drive(kAnn, late, now);
  }
  EXPECT_FALSE(control.order(now).active);
}

TEST_F(ControlTest, RepeatedAndBackdatedSamplesAreRefused) {
  take_and_drive();
  Control::Sample old = sample(true);
  EXPECT_EQ(control.drive(kAnn, old, now), "");
  EXPECT_EQ(control.drive(kAnn, old, now), "a repeated sample");
  Control::Sample back = sample(true);
  back.device_time -= 5.0;
  EXPECT_NE(control.drive(kAnn, back, now), "");
}

TEST_F(ControlTest, NumbersThatAreNoneAreRefused) {
  take_and_drive();
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Control::Sample wrong = sample(true);
    wrong.velocity = bad;
    EXPECT_NE(control.drive(kAnn, wrong, now), "");
    wrong = sample(true);
    wrong.rotation = bad;
    EXPECT_NE(control.drive(kAnn, wrong, now), "");
  }
}

TEST_F(ControlTest, OneHasControlAndTheOtherAsksOrTakes) {
  take_and_drive();
  EXPECT_NE(control.take(kBob, false, now), "");
  EXPECT_EQ(control.ask(kBob), "");
  ASSERT_EQ(control.state().asked.size(), 1U);
  EXPECT_EQ(control.state().asked[0].id, kBob);
  EXPECT_EQ(control.state().asked[0].name, "bob");
  EXPECT_EQ(control.holder(), kAnn);
  EXPECT_EQ(control.take(kBob, true, now), "");
  EXPECT_EQ(control.holder(), kBob);
  EXPECT_FALSE(control.order(now).active);
  EXPECT_EQ(control.drive(kAnn, sample(true), now), "you do not have control");
  EXPECT_TRUE(control.state().asked.empty());
}

TEST_F(ControlTest, ControlIsGivenToWhoAskedAndNothingMovesUntilThen) {
  take_and_drive();
  EXPECT_EQ(control.give(kAnn, kBob, now), "bob does not ask for control any more");
  EXPECT_EQ(control.ask(kBob), "");
  EXPECT_EQ(control.give(kBob, kBob, now), "you do not have control");
  EXPECT_EQ(control.holder(), kAnn);
  EXPECT_EQ(control.give(kAnn, kBob, now), "");
  EXPECT_EQ(control.holder(), kBob);
  EXPECT_TRUE(control.state().asked.empty());
  EXPECT_EQ(control.state().note, "ann gave control to bob");
  // A stick that bob held all along moves nothing.
  EXPECT_EQ(control.drive(kBob, sample(true), now), "it was held already when control came");
  EXPECT_FALSE(control.order(now).active);
  EXPECT_EQ(control.drive(kBob, sample(false), now), "");
  EXPECT_EQ(control.drive(kBob, sample(true), now), "");
  EXPECT_TRUE(control.order(now).active);
}

TEST_F(ControlTest, ReleasingAndLeavingStop) {
  take_and_drive();
  control.release(kBob);  // not bob's
  EXPECT_TRUE(control.order(now).active);
  control.release(kAnn);
  EXPECT_FALSE(control.order(now).active);
  take_and_drive();
  control.leave(kAnn);
  EXPECT_FALSE(control.order(now).active);
  EXPECT_EQ(control.holder(), 0U);
  EXPECT_NE(control.take(kAnn, false, now), "");
}

// The clock of a telephone is a little fast or slow.
TEST_F(ControlTest, ClocksThatDriftApartDoNotStopTheDriver) {
  take_and_drive();
  for (int i = 0; i < 20 * 600; ++i, now += 0.05) {
    device_ahead += 0.05 * 2e-4;
    EXPECT_EQ(control.drive(kAnn, sample(true), now), "");
    device_ahead -= 0.05 * 4e-4;
  }
}

}  // namespace
}  // namespace saphira::teleop
