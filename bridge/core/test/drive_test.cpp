#include <gtest/gtest.h>

#include <limits>

#include "scene.hpp"

namespace saphira::bridge::test {
namespace {

using authority::Role;

TEST(Drive, TheStateGoesOutBeforeAnythingElseIsDoneWithIt) {
  Driven scene;
  scene.core.received(protocol::encode(scene.shown), scene.now);
  ASSERT_TRUE(scene.core.work(scene.now));
  const std::vector<Output> said = scene.core.take();
  ASSERT_EQ(said.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<CycleBegan>(said[0]));
  ASSERT_TRUE(scene.core.work(scene.now));
  EXPECT_FALSE(scene.core.take().empty());
  EXPECT_FALSE(scene.core.work(scene.now));
}

TEST(Drive, PacketsGoOutBeforeWords) {
  Driven scene;
  scene.cycle();
  scene.forget();
  scene.drive(Role::teleop, 0.2);
  ASSERT_GE(scene.said.size(), 4U);
  EXPECT_TRUE(std::holds_alternative<Send>(scene.said[0]));
  EXPECT_TRUE(std::holds_alternative<Answered>(scene.said[1]));
  EXPECT_TRUE(scene.noted("teleop drives (teleop)"));
  EXPECT_TRUE(scene.has<GrantDecided>());
}

TEST(Drive, TheAnswerOfADriverThatFollowsTheCyclesIsAwaited) {
  Driven scene;
  scene.cycle();
  EXPECT_TRUE(scene.core.awaits_answer());
  EXPECT_TRUE(scene.sent.empty());
  EXPECT_LE(scene.core.due(scene.now), scene.now + 0.05);
  scene.drive(Role::behaviors, 0.12);
  EXPECT_FALSE(scene.core.awaits_answer());
  EXPECT_TRUE(scene.was_sent(protocol::Velocity{0.12}));
}

TEST(Drive, WithoutItsAnswerTheCycleIsLate) {
  Driven scene;
  scene.cycle();
  scene.pass(0.06);
  EXPECT_FALSE(scene.core.awaits_answer());
  scene.pass(0.1);
  ASSERT_TRUE(scene.has<StatusReport>());
  EXPECT_EQ(scene.all<StatusReport>().back().late, 1U);
}

TEST(Drive, ALeaseThatRunsOutIsAStop) {
  Driven scene;
  for (int i = 0; i < 2; ++i)
    scene.cycle();
  EXPECT_EQ(scene.core.grant().role, Role::behaviors);
  EXPECT_FALSE(scene.was_stopped());
  scene.cycle();
  scene.pass_slowly(0.05);
  EXPECT_EQ(scene.core.grant().role, Role::none);
  EXPECT_TRUE(scene.was_stopped());
  EXPECT_TRUE(scene.noted("nobody drives: the lease of behaviors (behaviors) ran out"));
}

TEST(Drive, ADriverThatRepeatsAnOldAnswerLosesItsLease) {
  Driven scene;
  const std::uint64_t cycle = scene.core.stamp().cycle;
  for (int i = 0; i < 4; ++i) {
    scene.cycle();
    DriveCommand stuck = scene.wish(Role::behaviors, 0.1);
    stuck.command.cycle = cycle;
    scene.tell(stuck);
  }
  EXPECT_EQ(scene.core.grant().role, Role::none);
  EXPECT_TRUE(scene.was_stopped());
}

TEST(Drive, AReleaseIsAStopAtOnce) {
  Driven scene;
  DriveCommand release = scene.wish(Role::behaviors, 0.3);
  release.command.active = false;
  scene.tell(release);
  EXPECT_TRUE(scene.was_stopped());
  EXPECT_EQ(scene.core.grant().role, Role::none);
}

TEST(Drive, AReleaseIsHeardWhateverElseItSays) {
  Driven scene;
  DriveCommand release = scene.wish(Role::behaviors, std::numeric_limits<double>::quiet_NaN());
  release.command.active = false;
  release.wrong = "unknown translation mode";
  scene.tell(release);
  EXPECT_TRUE(scene.was_stopped());
}

TEST(Drive, ADriverThatLeavesTheBusIsAStopAtOnce) {
  Driven scene;
  scene.core.writer_lost(Role::behaviors, {}, scene.now);
  scene.answer();
  EXPECT_TRUE(scene.was_stopped());
}

TEST(Drive, NothingOfOneDriversWishesIsLeftToTheNext) {
  Driven scene;
  DriveCommand turn = scene.wish(Role::teleop, 0.3);
  turn.motion.translation = reflector::Translation::none;
  turn.motion.rotation_velocity = 0.2;
  scene.tell(turn);
  EXPECT_EQ(scene.core.grant().role, Role::teleop);
  EXPECT_TRUE(scene.was_sent(protocol::Velocity{0.0}));
  EXPECT_FALSE(scene.was_moved());
}

TEST(Drive, ACommandThatMeansNothingIsRefusedAndCounted) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Driven scene;
  scene.cycle();
  DriveCommand bad = scene.wish(Role::teleop, nan);
  scene.tell(bad);
  bad = scene.wish(Role::teleop, 0.1);
  bad.contact_speed = 1e300;
  scene.tell(bad);
  bad = scene.wish(Role::teleop, 0.1);
  bad.wrong = "unknown rotation mode";
  scene.tell(bad);
  EXPECT_EQ(scene.core.grant().role, Role::behaviors);
  scene.forget();
  scene.cycle();
  std::vector<std::string> reasons;
  for (const GrantDecided& grant : scene.all<GrantDecided>())
    for (const authority::Refusal& refusal : grant.refused)
      reasons.push_back(refusal.reason);
  EXPECT_EQ(reasons, (std::vector<std::string>{"velocity is no usable number",
                                               "contact_speed is no usable number",
                                               "unknown rotation mode"}));
  scene.pass_slowly(0.2);
  EXPECT_EQ(scene.all<StatusReport>().back().refused, 3U);
}

TEST(Drive, TheGuardStopsBeforeWhatIsHeardAndSaysSo) {
  Driven scene;
  for (int i = 0; i < 4; ++i) {
    // 0.4 m ahead of the sonar that looks ahead.
    scene.shown.sonars = {{0, static_cast<std::uint16_t>(0.2 / scene.robot.range_unit)}};
    scene.cycles(1, Role::behaviors, 0.3);
  }
  ASSERT_TRUE(scene.has<GrantDecided>());
  EXPECT_EQ(scene.all<GrantDecided>().back().guarded.action, authority::GuardAction::stop);
  EXPECT_TRUE(scene.noted("guard: "));
  const auto reason = [&] { return scene.all<GrantDecided>().back().guarded.reason; };
  EXPECT_NE(reason().find(" m ahead; it lets go beyond "), std::string::npos) << reason();
  EXPECT_NE(reason().find("; sonar 0 hea"), std::string::npos) << reason();
  scene.shown.sonars.clear();
  scene.cycles(6, Role::behaviors, 0.3);
  EXPECT_NE(reason().find("; sonar 0 heard it 0."), std::string::npos) << reason();
  EXPECT_TRUE(scene.was_sent(protocol::Velocity{0.0}));
}

TEST(Drive, TheGuardTakesAnEchoForAnEdgeOfTheDriversMap) {
  // A post that the sonar to the left, half ahead, hears at 0.40 m.
  const auto speed_past_it = [](double error) {
    Driven scene;
    for (int i = 0; i < 9; ++i) {
      scene.shown.sonars = {{1, static_cast<std::uint16_t>(0.40 / scene.robot.range_unit)}};
      scene.cycle();
      const Pose robot = scene.all<CycleBegan>().back().state.pose_in_odom;
      const Vec2 post =
          transform(compose(robot, scene.robot.sonars[1].pose_in_robot), {0.40 + error, 0.0});
      DriveCommand command = scene.wish(Role::behaviors, 0.3);
      command.motion.rotation_velocity = 0.0;
      command.edges = {{post, post}};
      scene.tell(command);
    }
    return scene.all<GrantDecided>().back().guarded.velocity;
  };
  const double at_the_post = speed_past_it(0.0);
  EXPECT_DOUBLE_EQ(speed_past_it(0.1), at_the_post);
  const double strange = speed_past_it(0.3);
  EXPECT_LT(strange, 0.5 * at_the_post);
  EXPECT_GE(speed_past_it(std::numeric_limits<double>::quiet_NaN()), strange)
      << "an edge that is no number counts as none";
}

TEST(Drive, ADriverThatIsSlowIsSlowed) {
  Driven scene;
  for (int i = 0; i < 10; ++i) {
    scene.cycle();
    DriveCommand late = scene.wish(Role::behaviors, 0.4);
    late.command.cycle -= 7;
    scene.tell(late);
  }
  EXPECT_EQ(scene.core.grant().role, Role::behaviors);
  EXPECT_GT(scene.core.grant().command_age, 0.6);
  const authority::Guarded guarded = scene.all<GrantDecided>().back().guarded;
  EXPECT_NE(guarded.reason.find("the command answers what the robot said"), std::string::npos);
  EXPECT_LT(guarded.velocity, 0.3);
}

// ---- The emergency stop.

TEST(Estop, WinsOverAllAndIsTheHardestStop) {
  Driven scene(Role::teleop);
  scene.estop(true);
  EXPECT_TRUE(scene.was_stopped());
  EXPECT_TRUE(scene.was_sent(protocol::EmergencyStop{}));
  EXPECT_EQ(scene.core.grant().role, Role::estop);
  scene.forget();
  for (const Role role : {Role::teleop, Role::direct, Role::behaviors})
    scene.cycles(3, role, 0.3);
  EXPECT_FALSE(scene.was_moved());
  EXPECT_EQ(scene.core.grant().role, Role::estop);
}

TEST(Estop, IsHeardWhateverItSays) {
  Driven scene;
  DriveCommand press = scene.wish(Role::estop, std::numeric_limits<double>::quiet_NaN());
  press.command.epoch = 77;
  press.command.number = 0;
  press.wrong = "unknown translation mode";
  scene.tell(press);
  EXPECT_TRUE(scene.core.latches().estopped);
  EXPECT_TRUE(scene.was_stopped());
}

TEST(Estop, IsKeptAndToldOnceAndHoldsOverSessions) {
  Driven scene;
  scene.estop(true);
  scene.estop(true);
  ASSERT_EQ(scene.all<KeepLatches>().size(), 1U);
  EXPECT_TRUE(scene.all<KeepLatches>()[0].latches.estopped);
  EXPECT_TRUE(scene.noted("(without --state a restart forgets it)"));
  scene.core.link_closed("cut", scene.now);
  scene.deliver();
  scene.forget();
  scene.connect();
  scene.cycles(3, Role::behaviors);
  EXPECT_FALSE(scene.was_moved());
  EXPECT_TRUE(scene.was_stopped());
  EXPECT_EQ(scene.condition().health, v1::SERVICE_DEGRADED);
}

TEST(Estop, HoldsOverARestart) {
  Scene scene;
  scene.core.restore({true, "a person", authority::Wait::none});
  scene.deliver();
  EXPECT_TRUE(scene.noted("an emergency stop is latched from before the start"));
  scene.connect();
  scene.cycles(3, Role::behaviors);
  EXPECT_FALSE(scene.was_moved());
  EXPECT_FALSE(scene.has<KeepLatches>()) << "nothing has changed";
}

TEST(Estop, WithoutARobotItIsToldAtOnce) {
  Scene scene;
  scene.estop(true);
  ASSERT_TRUE(scene.has<GrantDecided>());
  EXPECT_TRUE(scene.all<GrantDecided>().back().grant.estopped);
  EXPECT_TRUE(scene.has<KeepLatches>());
}

TEST(Estop, ItsReleaseMovesNothing) {
  Driven scene(Role::teleop);
  scene.estop(true);
  scene.reset("another");
  scene.answer();
  EXPECT_TRUE(scene.noted("emergency stop not reset by another: estop still presses"));
  EXPECT_TRUE(scene.core.latches().estopped);
  scene.estop(false);
  scene.reset("another");
  scene.answer();
  EXPECT_TRUE(scene.noted("emergency stop reset by another"));
  EXPECT_FALSE(scene.core.latches().estopped);
  EXPECT_FALSE(scene.all<KeepLatches>().back().latches.estopped);
  scene.forget();
  scene.cycles(2, Role::teleop);
  EXPECT_FALSE(scene.was_moved()) << "the person lets go first";
  scene.forget();
  scene.reset("another");
  scene.deliver();
  EXPECT_TRUE(scene.said.empty()) << "none is latched";
}

}  // namespace
}  // namespace saphira::bridge::test
