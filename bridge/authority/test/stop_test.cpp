// A stop: it ends the driving of everybody, and whoever drove lets go or begins anew.
#include <gtest/gtest.h>

#include "scene.hpp"

namespace saphira::authority {
namespace {

using test::Scene;
using Words = std::vector<std::string>;

struct StopScene : Scene {
  Words stop(std::uint64_t id = 1) { return arbiter.stop({7, id}, "a person", now, cycle); }
  /// The writer goes on as if nothing had happened.
  Role goes_on(Role role, int who, v1::StopId heeds = {}) {
    wait(1);
    Command c = command(role, who);
    c.heeds = heeds;
    arbiter.offer(c, cycle);
    return driver();
  }
};

TEST(Stop, EndsEveryRoleUntilItsWriterLetsGo) {
  for (const Role role : {Role::teleop, Role::direct}) {
    StopScene s;
    s.offer(role, 1);
    ASSERT_EQ(s.driver(), role);
    EXPECT_EQ(s.stop(), Words{std::string(name(role)) + "1 (" + name(role) + ")"});
    EXPECT_EQ(s.driver(), Role::none);
    for (int i = 0; i < 50; ++i)
      ASSERT_EQ(s.goes_on(role, 1), Role::none) << name(role) << i;
    EXPECT_EQ(s.grant().reason, "stopped by a person: let go first, then drive");
    s.offer(role, 1, false);
    EXPECT_EQ(s.goes_on(role, 1), role);
  }
}

TEST(Stop, ThePresentGrantNamesIt) {
  StopScene s;
  EXPECT_EQ(s.grant().stop, v1::StopId{});
  s.stop(3);
  EXPECT_EQ(s.grant().stop, (v1::StopId{7, 3}));
  EXPECT_EQ(s.grant().stop_source, "a person");
}

// A release of the behaviors says nothing about the intent of the next cycle.
TEST(Stop, BehaviorsDriveAgainOnceTheyHeedIt) {
  StopScene s;
  s.offer(Role::behaviors, 1);
  s.stop(1);
  EXPECT_EQ(s.goes_on(Role::behaviors, 1), Role::none);
  s.offer(Role::behaviors, 1, false);
  EXPECT_EQ(s.goes_on(Role::behaviors, 1), Role::none);
  EXPECT_EQ(s.goes_on(Role::behaviors, 1, {7, 2}), Role::none) << "another stop";
  EXPECT_EQ(s.goes_on(Role::behaviors, 1, {7, 1}), Role::behaviors);
  s.stop(2);
  EXPECT_EQ(s.goes_on(Role::behaviors, 1, {7, 1}), Role::none);
}

TEST(Stop, BehaviorsThatWereSilentHeedItToo) {
  StopScene s;
  s.stop(1);
  EXPECT_EQ(s.goes_on(Role::behaviors, 1), Role::none);
  EXPECT_EQ(s.goes_on(Role::behaviors, 1, {7, 1}), Role::behaviors);
}

TEST(Stop, EndsAlsoThoseThatWaitedBehindTheDriver) {
  StopScene s;
  s.offer(Role::teleop, 1);
  s.offer(Role::direct, 2);
  s.offer(Role::direct, 3);  // refused: the role is held
  s.offer(Role::behaviors, 4);
  ASSERT_EQ(s.driver(), Role::teleop);
  EXPECT_EQ(s.stop(), (Words{"teleop1 (teleop)", "direct2 (direct)", "direct3 (direct)",
                             "behaviors4 (behaviors)"}));
  s.offer(Role::teleop, 1, false);
  s.hand_back(1);
  EXPECT_EQ(s.goes_on(Role::direct, 2), Role::none);
  EXPECT_EQ(s.goes_on(Role::direct, 3), Role::none);
  s.offer(Role::direct, 3, false);
  EXPECT_EQ(s.goes_on(Role::direct, 3), Role::direct) << "direct2 holds the role no more";
}

TEST(Stop, AProgramThatBeginsAfterwardsDrives) {
  StopScene s;
  s.offer(Role::direct, 1);
  s.stop();
  EXPECT_EQ(s.goes_on(Role::direct, 2), Role::direct);
}

TEST(Stop, AStoppedProgramDoesNotKeepAGoalOfAfterwardsFromDriving) {
  StopScene s;
  s.offer(Role::direct, 1);
  s.stop(1);
  EXPECT_EQ(s.goes_on(Role::direct, 1), Role::none);
  EXPECT_EQ(s.goes_on(Role::behaviors, 2, {7, 1}), Role::behaviors);
  EXPECT_EQ(s.arbiter.take_refused().back(),
            (Refusal{Role::direct, "direct1", "stopped by a person: let go first, then drive"}));
}

TEST(Stop, HoldsForAWriterThatIsSilentMeanwhile) {
  StopScene s;
  s.offer(Role::direct, 1);
  ASSERT_EQ(s.driver(), Role::direct);
  s.wait(20);
  EXPECT_EQ(s.stop(), Words{}) << "it does not drive now";
  s.wait(100);
  EXPECT_EQ(s.goes_on(Role::direct, 1), Role::none);
}

// Its commands were on the way.
TEST(Stop, HoldsForAWriterThatWasNotHeardBefore) {
  StopScene s;
  Command late = s.command(Role::direct, 1);
  s.stop();
  s.now += 0.05;
  late.received = s.now;
  EXPECT_TRUE(s.arbiter.offer(late, s.cycle));
  EXPECT_EQ(s.driver(), Role::none);
  EXPECT_EQ(s.goes_on(Role::direct, 1), Role::none);
}

TEST(Stop, HoldsOverAConnectionAndALossOfTheWriter) {
  for (const Role role : {Role::teleop, Role::direct}) {
    StopScene s;
    s.offer(role, 1);
    s.stop();
    s.arbiter.lost(role, test::writer(1), s.now);
    EXPECT_EQ(s.goes_on(role, 1), Role::none);
    s.arbiter.connect(2);
    s.cycle = 0;
    s.wait(1);
    Command anew = s.command(role, 1);
    anew.epoch = 2;
    s.arbiter.offer(anew, s.cycle);
    EXPECT_EQ(s.driver(), Role::none);
  }
}

// Otherwise its command of before would drive.
TEST(Stop, ARefusedCommandHeedsNothing) {
  StopScene s;
  s.offer(Role::direct, 1);
  s.stop(1);
  Command early = s.command(Role::direct, 1);
  early.cycle = s.cycle + 1;
  early.heeds = {7, 1};
  EXPECT_FALSE(s.arbiter.offer(early, s.cycle));
  EXPECT_EQ(s.driver(), Role::none);
}

TEST(Stop, TheLastToStopIsWhoeverDidByEitherMeans) {
  StopScene s;
  s.stop(1);
  const std::string first = s.grant().stop_source;
  s.offer(Role::estop, 4);
  s.offer(Role::estop, 4, false);
  s.arbiter.reset("somebody", s.now);
  EXPECT_EQ(s.grant().stop_source, "estop4");
  s.stop(1);
  EXPECT_EQ(s.grant().stop_source, first);
}

TEST(Stop, LeavesTheEmergencyStopLatched) {
  StopScene s;
  s.offer(Role::estop, 1);
  s.stop();
  EXPECT_EQ(s.driver(), Role::estop);
}

}  // namespace
}  // namespace saphira::authority
