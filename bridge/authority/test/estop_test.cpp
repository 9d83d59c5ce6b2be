// The emergency stop: latched, and released only by a reset.
#include <gtest/gtest.h>

#include "saphira/base/random.hpp"
#include "scene.hpp"

namespace saphira::authority {
namespace {

using test::Scene;
using test::writer;

TEST(EmergencyStop, HoldsWithoutItsWriter) {
  Scene s;
  s.offer(Role::estop, 1);
  Grant grant = s.grant();
  EXPECT_EQ(grant.role, Role::estop);
  EXPECT_TRUE(grant.estopped);
  EXPECT_EQ(grant.estop_source, "estop1");
  s.arbiter.lost(Role::estop, writer(1), s.now);
  for (int i = 0; i < 1000; ++i) {
    s.wait(1);
    s.offer(Role::behaviors, 2);
    s.offer(Role::teleop, 3);
    s.offer(Role::direct, 4);
    ASSERT_EQ(s.driver(), Role::estop) << i;
  }
  EXPECT_NE(s.arbiter.take_refused().at(0).reason.find("pressed by estop1"), std::string::npos);
}

TEST(EmergencyStop, ALetGoButtonIsStillLatched) {
  Scene s;
  s.offer(Role::estop, 1);
  s.offer(Role::estop, 1, false);
  EXPECT_EQ(s.driver(), Role::estop);
}

TEST(EmergencyStop, IsHeardWhateverItAnswers) {
  Scene s;
  s.arbiter.forget(s.cycle, s.now + 10.0);
  Command c = s.command(Role::estop, 1);
  c.epoch = 77;
  c.cycle = 1;
  c.number = 0;
  EXPECT_TRUE(s.arbiter.offer(c, s.cycle));
  EXPECT_EQ(s.driver(), Role::estop);
}

TEST(EmergencyStop, HoldsOverAGapAndConnections) {
  Scene s;
  s.offer(Role::estop, 1);
  s.wait(10);
  s.arbiter.forget(s.cycle, s.now + 0.1);
  EXPECT_EQ(s.driver(), Role::estop);
  s.arbiter.connect(0);
  EXPECT_EQ(s.driver(), Role::estop);
  s.arbiter.connect(2);
  EXPECT_EQ(s.driver(), Role::estop);
  s.now = 0.0;  // where cycles are the clock, the clock restarts with them
  s.cycle = 1;
  EXPECT_EQ(s.driver(), Role::estop);
}

TEST(EmergencyStop, HoldsOverARestart) {
  Scene before;
  before.offer(Role::estop, 1);
  Scene after;
  after.arbiter.restore(latches_from_text(to_text(before.arbiter.latches())));
  after.offer(Role::behaviors, 2);
  const Grant grant = after.grant();
  EXPECT_EQ(grant.role, Role::estop);
  EXPECT_EQ(grant.estop_source, "estop1");
}

TEST(EmergencyStop, TheFirstToPressIsNamed) {
  Scene s;
  s.offer(Role::estop, 1);
  s.offer(Role::estop, 2);
  EXPECT_EQ(s.grant().estop_source, "estop1");
}

TEST(EmergencyStop, IsNotResetWhileAnybodyPresses) {
  Scene s;
  s.offer(Role::estop, 1);
  s.offer(Role::estop, 2);
  s.offer(Role::estop, 1, false);
  EXPECT_EQ(s.arbiter.reset("keyboard", s.now),
            "estop2 still presses the emergency stop: let it go first");
  EXPECT_EQ(s.driver(), Role::estop);
  EXPECT_EQ(s.arbiter.take_refused().at(0).source, "keyboard");
  s.wait(4);  // its lease ended
  EXPECT_EQ(s.arbiter.reset("keyboard", s.now), "");
  const Grant grant = s.grant();
  EXPECT_EQ(grant.role, Role::none);
  EXPECT_FALSE(grant.estopped);
  EXPECT_EQ(grant.estop_source, "");
}

TEST(EmergencyStop, AResetWithoutOneSaysSo) {
  Scene s;
  EXPECT_EQ(s.arbiter.reset("keyboard", s.now), "no emergency stop is latched");
  s.offer(Role::behaviors, 1);
  EXPECT_EQ(s.driver(), Role::behaviors);
}

void press_and_let_go(Scene& s) {
  s.offer(Role::estop, 9);
  s.offer(Role::estop, 9, false);
}

TEST(EmergencyStop, BehaviorsThatStillAskAtTheResetWaitForAPerson) {
  Scene s;
  press_and_let_go(s);
  s.offer(Role::behaviors, 1);
  ASSERT_EQ(s.arbiter.reset("keyboard", s.now), "");
  for (int i = 0; i < 200; ++i) {
    s.offer(Role::behaviors, 1, i % 20 != 10);  // also with pauses: their cause is unknown
    const Grant grant = s.grant();
    ASSERT_EQ(grant.role, Role::none);
    ASSERT_TRUE(grant.waits_for_hand_back);
    s.wait(1);
  }
  s.hand_back(2);
  s.offer(Role::behaviors, 1);
  EXPECT_EQ(s.driver(), Role::behaviors);
}

TEST(EmergencyStop, BehaviorsThatWereNotHeardAtTheResetWaitForAPerson) {
  Scene s;
  s.offer(Role::behaviors, 1);
  press_and_let_go(s);
  s.wait(50);  // cut off: they do not hear the stop
  ASSERT_EQ(s.arbiter.reset("keyboard", s.now), "");
  s.offer(Role::behaviors, 1, false);
  s.offer(Role::behaviors, 1);
  EXPECT_EQ(s.driver(), Role::none);
  EXPECT_TRUE(s.grant().waits_for_hand_back);
}

TEST(EmergencyStop, BehaviorsThatCameToRestBeginAnewByThemselves) {
  Scene s;
  s.offer(Role::behaviors, 1);
  press_and_let_go(s);
  s.wait(1);
  s.offer(Role::behaviors, 1, false);
  ASSERT_EQ(s.arbiter.reset("keyboard", s.now), "");
  EXPECT_EQ(s.driver(), Role::none);
  EXPECT_FALSE(s.grant().waits_for_hand_back);
  s.wait(1);
  s.offer(Role::behaviors, 1);
  EXPECT_EQ(s.driver(), Role::behaviors);
}

TEST(EmergencyStop, ADirectDriverThatStillAsksWaitsForAPerson) {
  Scene s;
  press_and_let_go(s);
  s.offer(Role::behaviors, 1, false);
  s.offer(Role::direct, 2);
  ASSERT_EQ(s.arbiter.reset("keyboard", s.now), "");
  s.offer(Role::direct, 2);
  EXPECT_EQ(s.driver(), Role::none);
  EXPECT_TRUE(s.grant().waits_for_hand_back);
}

TEST(EmergencyStop, APersonLetsGoBeforeDrivingAgain) {
  Scene s;
  press_and_let_go(s);
  s.offer(Role::teleop, 1);
  ASSERT_EQ(s.arbiter.reset("keyboard", s.now), "");
  for (const int pause : {1, 1, 1, 5, 50, 1}) {  // silence is no release
    s.wait(pause);
    s.offer(Role::teleop, 1);
    ASSERT_EQ(s.driver(), Role::none) << pause;
  }
  s.offer(Role::teleop, 1, false);
  s.offer(Role::teleop, 1);
  EXPECT_EQ(s.driver(), Role::teleop);
}

TEST(EmergencyStop, APersonWhoComesAfterTheResetDrivesAtOnce) {
  Scene s;
  press_and_let_go(s);
  ASSERT_EQ(s.arbiter.reset("keyboard", s.now), "");
  s.offer(Role::teleop, 1);
  EXPECT_EQ(s.driver(), Role::teleop);
}

TEST(EmergencyStop, IsNotReleasedByHandingBack) {
  Scene s;
  s.offer(Role::teleop, 1);
  s.driver();
  press_and_let_go(s);
  s.hand_back(1);
  EXPECT_EQ(s.driver(), Role::estop);
  EXPECT_NE(s.arbiter.take_refused().back().reason.find("saphira estop reset comes before"),
            std::string::npos);
  ASSERT_EQ(s.arbiter.reset("keyboard", s.now), "");
  EXPECT_TRUE(s.grant().waits_for_hand_back);
}

TEST(Latches, AreTheSameAfterTheirText) {
  EXPECT_EQ(to_text({}), "");
  EXPECT_EQ(latches_from_text(""), Latches{});
  for (const Wait wait : {Wait::none, Wait::driven, Wait::reset}) {
    for (const Latches& latches : {Latches{true, "a button\tof\nthe lab", wait},
                                   Latches{true, "", wait}, Latches{false, "", wait}})
      EXPECT_EQ(latches_from_text(to_text(latches)), latches);
  }
}

TEST(Latches, WhatCannotBeReadIsAnEmergencyStop) {
  const std::string whole = to_text({true, "button", Wait::driven});
  for (std::size_t size = 1; size < whole.size(); ++size)
    EXPECT_TRUE(latches_from_text(whole.substr(0, size)).estopped) << size;
  Random random(1);
  for (int i = 0; i < 10000; ++i) {
    std::string text = whole;
    text[random.next() % text.size()] ^= static_cast<char>(1U << (random.next() % 8));
    const Latches latches = latches_from_text(text);
    EXPECT_TRUE(latches.estopped) << text;
  }
}

}  // namespace
}  // namespace saphira::authority
