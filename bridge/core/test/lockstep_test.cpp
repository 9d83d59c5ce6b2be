#include <gtest/gtest.h>

#include "scene.hpp"

namespace saphira::bridge::test {
namespace {

using authority::Role;

CoreSettings lockstep(bool free_step = false) {
  CoreSettings settings;
  settings.lockstep = true;
  settings.free_step = free_step;
  return settings;
}

struct Stepped : Scene {
  explicit Stepped(bool free_step = false) : Scene(lockstep(free_step)) {
    connect();
    core.permit(3);
    answer();
  }
  int steps() const { return times_sent(protocol::Step{}); }
};

TEST(Lockstep, StepsWithinThePermit) {
  Scene scene(lockstep());
  scene.connect();
  EXPECT_EQ(scene.times_sent(protocol::Step{}), 0);
  EXPECT_FALSE(scene.has<WatchLink>()) << "its world stands still by itself";
  scene.pass(0.1);
  EXPECT_EQ(scene.condition().reason, "waits for a permit to step");
  scene.core.permit(3);
  scene.answer();
  EXPECT_EQ(scene.times_sent(protocol::Step{}), 1);
  scene.cycles(2, Role::behaviors);
  EXPECT_EQ(scene.times_sent(protocol::Step{}), 3);
  scene.cycles(1, Role::behaviors);
  EXPECT_EQ(scene.times_sent(protocol::Step{}), 3) << "cycle 3 is the last of the permit";
}

TEST(Lockstep, WaitsForTheAnswerOfTheBehaviors) {
  Stepped scene;
  scene.cycle();
  EXPECT_EQ(scene.steps(), 1);
  scene.drive(Role::teleop);
  EXPECT_EQ(scene.steps(), 1);
  scene.pass(0.1);
  EXPECT_EQ(scene.condition().reason, "waits for the behaviors' command for cycle 1");
  scene.drive(Role::behaviors);
  EXPECT_EQ(scene.steps(), 2);
  EXPECT_EQ(scene.all<GrantDecided>().back().grant.role, Role::teleop);
}

TEST(Lockstep, AMalformedAnswerIsOne) {
  Stepped scene;
  scene.cycle();
  DriveCommand bad = scene.wish(Role::behaviors, 0.1);
  bad.wrong = "unknown translation mode";
  scene.tell(bad);
  EXPECT_EQ(scene.steps(), 2);
  EXPECT_EQ(scene.core.grant().role, Role::none);
}

TEST(Lockstep, AnAnswerToAnotherCycleIsNone) {
  Stepped scene;
  scene.cycle();
  DriveCommand early = scene.wish(Role::behaviors, 0.1);
  ++early.command.cycle;
  scene.tell(early);
  EXPECT_EQ(scene.steps(), 1);
  scene.drive(Role::behaviors);
  scene.cycle();
  EXPECT_EQ(scene.steps(), 2) << "what came too early is no answer to the cycle that came later";
}

TEST(Lockstep, AnOldSampleBehindTheAnswerTakesNothingBack) {
  Stepped scene;
  scene.cycles(1, Role::behaviors);
  scene.cycle();
  DriveCommand old = scene.wish(Role::behaviors, 0.1);
  --old.command.cycle;
  scene.core.command(scene.wish(Role::behaviors, 0.1), scene.now);
  scene.core.command(old, scene.now);
  scene.answer();
  EXPECT_EQ(scene.steps(), 3);
}

TEST(Lockstep, FreeStepsNeedNoPermit) {
  Scene scene(lockstep(true));
  scene.connect();
  EXPECT_EQ(scene.times_sent(protocol::Step{}), 1);
  scene.cycles(3, Role::behaviors);
  EXPECT_EQ(scene.times_sent(protocol::Step{}), 4);
}

TEST(Lockstep, NoClockCounts) {
  Stepped scene;
  scene.cycle();
  scene.pass(5.0);
  scene.drive(Role::behaviors, 0.1);
  EXPECT_EQ(scene.core.grant().role, Role::behaviors);
  scene.pass(5.0);
  EXPECT_FALSE(scene.noted("stood still"));
  EXPECT_FALSE(scene.noted("silent"));
  EXPECT_TRUE(scene.core.in_session());
}

TEST(Lockstep, LeasesCountCycles) {
  Stepped scene;
  scene.core.permit(100);
  scene.cycles(1, Role::behaviors);
  scene.cycle();
  scene.drive(Role::teleop);
  scene.drive(Role::behaviors);
  for (int i = 0; i < 3; ++i) {
    scene.cycle();
    scene.drive(Role::behaviors);
    EXPECT_EQ(scene.core.grant().role, Role::teleop) << i;
  }
  scene.cycle();
  scene.drive(Role::behaviors);
  EXPECT_EQ(scene.core.grant().role, Role::none) << "autonomy waits to be handed the robot back";
}

TEST(Lockstep, ASimulatorThatDoesNotStepIsGivenUp) {
  Stepped scene;
  scene.pass(9.9);
  EXPECT_TRUE(scene.core.in_session());
  scene.pass(0.2);
  EXPECT_FALSE(scene.core.in_session());
  EXPECT_TRUE(scene.noted("the simulator did not make a step within 10 s"));
}

TEST(Lockstep, AnEmergencyStopIsToldAtOnceAndHoldsFromTheNextAnswer) {
  Stepped scene;
  scene.core.permit(100);
  scene.cycles(3, Role::behaviors);
  scene.cycle();
  scene.forget();
  scene.estop(true);
  ASSERT_TRUE(scene.has<GrantDecided>());
  EXPECT_TRUE(scene.all<GrantDecided>().back().grant.estopped);
  scene.drive(Role::behaviors, 0.3);
  EXPECT_TRUE(scene.was_stopped());
  EXPECT_FALSE(scene.was_moved());
}

}  // namespace
}  // namespace saphira::bridge::test
