#include "saphira/intentions/work.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "saphira/base/text.hpp"
#include "saphira/intentions/executor.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/intentions/language.hpp"
#include "scripted_robot.hpp"

// Finished work is not done again: the service is killed and restarted at every cycle of a run, and
// the robot's total motion is the same as without a kill.
namespace saphira::intentions {
namespace {

/// A service that can be killed, with its disk, a robot, and one goal whose writer lives on.
class Site {
 public:
  Site(std::string activities, std::string functor, Arguments arguments = {})
      : activities_(std::move(activities)) {
    goal_.id = {1, 1};
    goal_.requester = "somebody";
    goal_.functor = std::move(functor);
    goal_.arguments = std::move(arguments);
    start();
  }

  void start() {
    Registry registry = built_in();
    const Loaded loaded = load_activities({{"test.act", activities_}}, *functions_, registry);
    EXPECT_TRUE(loaded.ok());
    for (const Schema& schema : loaded.schemas)
      registry.add(schema);
    const auto memory = restored<Memory>(disk);
    executor_ = std::make_unique<Executor>(
        std::move(registry), memory,
        ExecutorOptions{.remembers_work = true, .functions = functions_});
    events_ = {{GoalEvent::Kind::kWritten, goal_}};
    events_[0].needs_approval = needs_approval;
  }
  /// Its writer changes it.
  void change(Arguments arguments) {
    goal_.arguments = std::move(arguments);
    events_ = {{GoalEvent::Kind::kWritten, goal_}};
    events_[0].needs_approval = needs_approval;
  }
  bool approve() { return executor_->approve(goal_.id); }
  /// Dead for so many cycles, in which the robot stands.
  void kill(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      ++cycle;
      world.move({});
    }
    world.levels.clear();
    start();
  }
  void change_activities(std::string text) { activities_ = std::move(text); }

  void step() {
    ++cycle;
    Inputs inputs;
    inputs.epoch = epoch;
    inputs.cycle = cycle;
    inputs.robot = world.robot;
    inputs.behaviors = world.levels;
    inputs.behaviors_cycle = cycle - 1;
    inputs.events = std::exchange(events_, {});
    const Outputs out = executor_->step(inputs);
    for (const GoalStatus& each : out.updates.changed)
      status = each;
    auto memory = restored<Memory>(disk);
    for (const Ending& each : out.updates.endings)
      memory.endings.push_back(each);
    if (out.updates.work)
      memory.work = *out.updates.work;
    disk = saved(memory);
    for (const SpokenText& each : out.said)
      said += each.text + "\n";
    const Pose before = world.robot.pose_in_odom;
    world.move(out.behaviors);
    turned += norm2_angle(world.robot.pose_in_odom.th - before.th);
    driven += (world.robot.pose_in_odom.position() - before.position()).norm();
  }
  bool over() const { return ended(status.state); }

  ScriptedRobot world;
  bool needs_approval = false;  ///< the goal, from the next time on that it is heard
  std::uint64_t epoch = 100;
  std::uint64_t cycle = 0;
  std::string disk = saved(Memory{});
  GoalStatus status;
  std::string said;
  double turned = 0.0;  ///< [rad]
  double driven = 0.0;  ///< [m]

 private:
  std::string activities_;
  Goal goal_;
  std::shared_ptr<const Functions> functions_ = std::make_shared<const Functions>(core_functions());
  std::unique_ptr<Executor> executor_;
  std::vector<GoalEvent> events_;
};

constexpr const char* kAboutTurn =
    "(defintention :about-turn :goals '((INTEND :Stop () :blocking nil :priority 3)"
    " (INTEND :TurnTo ((goal . (offset (robot) -1000 0)) (success_angle . 0.1)) :timeout 20s)"
    " (WAIT-FOR at-rest :timeout 5s)))";

constexpr const char* kErrand =
    "(defintention :errand :goals '((EXECUTE (setq *pace* 0.4))"
    " (EXECUTE (believe-while 'on-errand \"on\"))"
    " (INTEND :Stop () :blocking nil :priority 3 :name stand)"
    " (EXECUTE (say \"sets out\"))"
    " (INTEND :GoToPos ((goal . (offset (robot) 1 0)) (speed . *pace*) (radius . 0.05))"
    "   :timeout 20s)"
    " (EXECUTE (say \"has ~a\" 'it))"
    " (INTEND :detour ((far . 0.6)) :name way)"
    " (AND (INTEND :TurnTo ((goal . (offset (robot) 0 1000)) (success_angle . 0.1)))"
    "      ((WAIT-FOR (> (elapsed) 4) :timeout 20s) (EXECUTE (say \"was there\"))))"
    " (MAINTAIN connected :by (FAIL \"no robot\")"
    "   (INTEND :detour ((far . 0.3))))"
    " ((= round 0))"
    " (:again (= round (+ round 1)) (EXECUTE (say \"round ~a\" round))"
    "   (WAIT-FOR at-rest :timeout 5s) (IF (< round 3) (GOTO :again)))"
    " (SUCCEED \"~a, ~a, ~a\" (state 'way) *pace* (belief 'on-errand))))"
    "(defintention :detour :params ((far :number 1)) :goals '("
    " ((= was (robot))"
    "  (INTEND :GoToPos ((goal . (offset (robot) far 0)) (speed . 0.2) (radius . 0.05))))"
    " (EXECUTE (say \"~a cm on\" (floor (+ 0.5 (* 100 (distance was))))))"
    " (WAIT-FOR at-rest :timeout 5s)))";

TEST(Work, AHalfTurnIsAHalfTurnHoweverOftenTheServiceIsKilled) {
  Site site(kAboutTurn, "about-turn");
  for (int i = 0; !site.over() && i < 300; ++i) {
    site.step();
    if (!site.over() && i % 5 == 4)
      site.kill(1);
  }
  EXPECT_EQ(site.status.state, v1::GOAL_SUCCEEDED) << site.status.reason;
  EXPECT_NEAR(site.turned, kPi, 0.11);
}

TEST(Work, StepsThatAreDoneAreNotDoneAgain) {
  Site whole(kErrand, "errand");
  std::uint64_t cycles = 0;
  for (; !whole.over() && cycles < 500; ++cycles)
    whole.step();
  ASSERT_EQ(whole.status.state, v1::GOAL_SUCCEEDED) << whole.status.reason << whole.said;
  EXPECT_EQ(whole.status.reason, "success, 0.4, on");
  EXPECT_NEAR(whole.driven, 1.9, 0.2);
  for (std::uint64_t at = 1; at < cycles; ++at) {
    Site site(kErrand, "errand");
    for (std::uint64_t i = 0; !site.over() && i < 700; ++i) {
      site.step();
      if (i + 1 == at)
        site.kill(2);
    }
    EXPECT_EQ(site.status.state, v1::GOAL_SUCCEEDED) << at << " " << site.status.reason;
    EXPECT_EQ(site.status.reason, whole.status.reason) << at;
    EXPECT_EQ(site.said, whole.said) << "killed at cycle " << at;
    EXPECT_NEAR(site.driven, whole.driven, 0.1) << "killed at cycle " << at;
    EXPECT_NEAR(site.turned, whole.turned, 0.11) << "killed at cycle " << at;
  }
}

/// Killed during its turn, and since then it is unknown where the robot is.
Site killed_without_its_place() {
  Site site(kAboutTurn, "about-turn");
  site.world.robot.odom_in_map = Pose{};
  for (int i = 0; i < 10; ++i)
    site.step();
  site.kill(1);
  site.world.robot.odom_in_map.reset();
  return site;
}

TEST(Work, GoesOnWhenThePlaceOfTheRobotIsHeardAgain) {
  Site site = killed_without_its_place();
  const double turned = site.turned;
  for (int i = 0; i < 20; ++i)
    site.step();
  EXPECT_EQ(site.turned, turned);
  EXPECT_EQ(site.status.reason, "waits until it is known where the robot is");
  site.world.robot.odom_in_map = Pose{};
  for (int i = 0; !site.over() && i < 300; ++i)
    site.step();
  EXPECT_EQ(site.status.state, v1::GOAL_SUCCEEDED) << site.status.reason;
  EXPECT_EQ(site.status.note, "");
  EXPECT_NEAR(site.turned, kPi, 0.11);
}

TEST(Work, WaitsForThePlaceOfTheRobotForFiveSeconds) {
  Site site = killed_without_its_place();
  for (int i = 0; !site.over() && i < 300; ++i)
    site.step();
  EXPECT_EQ(site.status.state, v1::GOAL_SUCCEEDED) << site.status.reason;
}

TEST(Work, ATextThatIsBelievedOutlivesAnotherOdomFrameAndAPlaceDoesNot) {
  Site site(
      "(defintention :it :goals '((IF (belief 'load) (SUCCEED \"~a, ~a\" (belief 'load) (belief "
      "'spot))) (EXECUTE (believe 'load \"EJ-231\")) (EXECUTE (believe 'spot (robot))) (WAIT 60)))",
      "it");
  for (int i = 0; i < 5; ++i)
    site.step();
  site.world.robot.odom = 2;
  site.kill(0);
  for (int i = 0; i < 3; ++i)
    site.step();
  EXPECT_EQ(site.status.reason, "EJ-231, nil");
}

// The bridge was restarted as well, and keeps its odom frame.
TEST(Work, AnotherEpochGoesOn) {
  Site site(kAboutTurn, "about-turn");
  for (int i = 0; i < 10; ++i)
    site.step();
  site.epoch = 101;
  site.cycle = 0;
  site.kill(0);
  for (int i = 0; !site.over() && i < 300; ++i)
    site.step();
  EXPECT_EQ(site.status.state, v1::GOAL_SUCCEEDED) << site.status.reason;
  EXPECT_NEAR(site.turned, kPi, 0.11);
}

TEST(Work, WhatCannotBeTakenUpIsTold) {
  struct Case {
    const char* what;
    std::function<void(Site&)> happens;
    const char* told;
  };
  const Case cases[] = {
      {"another version of the schema",
       [](Site& site) {
         site.change_activities(
             "(defintention :about-turn :goals '((INTEND :TurnTo ((goal . (offset (robot) -1000 "
             "0)) (success_angle . 0.2)))))");
       },
       "is another than it was"},
      {"another odom frame", [](Site& site) { site.world.robot.odom = 2; },
       "dead reckoning has begun anew"},
  };
  for (const Case& one : cases) {
    SCOPED_TRACE(one.what);
    Site site(kAboutTurn, "about-turn");
    for (int i = 0; i < 8; ++i)
      site.step();
    one.happens(site);
    site.kill(0);
    site.step();
    EXPECT_EQ(site.status.state, v1::GOAL_UNDERWAY);
    EXPECT_NE(site.status.note.find("begun anew"), std::string::npos) << site.status.note;
    EXPECT_NE(site.status.note.find(one.told), std::string::npos) << site.status.note;
  }
}

// A person approves a goal as it is, and not what its writer makes of it while nobody listens.
TEST(Work, AGoalThatWasChangedMeanwhileIsApprovedAnew) {
  const auto far = [](double metres) { return Arguments{number("far", metres)}; };
  const char* const kWay =
      "(defintention :way :params ((far :number 1)) :goals '("
      " (INTEND :GoToPos ((goal . (offset (robot) far 0)) (speed . 0.4) (radius . 0.05))"
      "   :timeout 20s)))";
  for (const bool changed_before : {false, true}) {
    SCOPED_TRACE(changed_before);
    Site site(kWay, "way", far(1.0));
    site.needs_approval = true;
    site.kill(0);
    site.step();
    EXPECT_EQ(site.status.code, v1::CODE_APPROVAL);
    EXPECT_TRUE(site.approve());
    for (int i = 0; i < 8; ++i)
      site.step();
    ASSERT_EQ(site.status.state, v1::GOAL_UNDERWAY);
    site.kill(1);
    site.step();
    EXPECT_EQ(site.status.state, v1::GOAL_UNDERWAY) << "the same goal goes on";

    site.change(far(2.0));
    if (changed_before)
      site.step();
    site.kill(1);
    site.step();
    EXPECT_EQ(site.status.code, v1::CODE_APPROVAL);
    const double driven = site.driven;
    site.step();
    EXPECT_EQ(site.driven, driven);
    EXPECT_TRUE(site.approve());
    while (!site.over())
      site.step();
    EXPECT_EQ(site.status.state, v1::GOAL_SUCCEEDED) << site.status.reason;
    EXPECT_NEAR(site.driven, driven + 2.0, 0.1) << "from its first step";
  }
}

}  // namespace
}  // namespace saphira::intentions
