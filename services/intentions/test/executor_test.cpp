#include "saphira/intentions/executor.hpp"

#include <gtest/gtest.h>

#include "bench.hpp"

namespace saphira::intentions {
namespace {

const Arguments kFar = {point("position", {50.0, 0.0, 0.0})};
const Arguments kSlow = {number("speed", 0.1)};

TEST(Executor, IntendsNothingWithoutAGoal) {
  Bench bench;
  bench.step();
  EXPECT_TRUE(bench.out.behaviors.empty());
  EXPECT_TRUE(bench.out.nodes.empty());
  EXPECT_EQ(bench.published, 0U);
}

TEST(Executor, RefusesWithAReason) {
  Bench bench;
  bench.ask(1, "fly", {});
  bench.ask(2, "go_to", {});
  Goal late = Bench::goal(3, "stop", {});
  late.deadline = -1.0;
  bench.write(late);
  bench.step();
  EXPECT_EQ(bench.state(1), v1::GOAL_REFUSED);
  EXPECT_EQ(bench.status(1).code, v1::CODE_UNKNOWN_FUNCTOR);
  EXPECT_EQ(bench.status(1).reason,
            "there is no activity \"fly\": saphira goal activities lists the 6 that there are");
  bench.begin(4, "go_too", {});
  EXPECT_EQ(bench.status(4).reason,
            "there is no activity \"go_too\": did you mean go_to? saphira goal activities lists "
            "the 6 that there are");
  EXPECT_EQ(bench.status(2).code, v1::CODE_BAD_ARGUMENT);
  EXPECT_EQ(bench.status(3).reason, "expected a deadline of 0 (none) or more seconds, got -1");
  EXPECT_TRUE(bench.out.behaviors.empty());
}

TEST(Executor, OfALongReasonTheBeginningIsRemembered) {
  Bench bench;
  const Arguments wrong{text("position", std::string(300, 'x'))};
  bench.begin(1, "go_to", wrong);
  const std::string whole = bench.status(1).reason;
  ASSERT_GT(whole.size(), kLongestReason);
  Bench again(bench.memory());
  again.begin(1, "go_to", wrong);
  EXPECT_EQ(again.state(1), v1::GOAL_REFUSED);
  EXPECT_EQ(again.status(1).reason, whole.substr(0, kLongestReason - 3) + "...");
}

TEST(Executor, RefusesAnIdThatIsNone) {
  Bench bench;
  Goal goal = Bench::goal(0, "stop", {});
  goal.id = {};
  bench.write(goal);
  bench.step();
  EXPECT_EQ(bench.state(0), v1::GOAL_REFUSED);
}

TEST(Executor, RefusesWhatIsTooMany) {
  ExecutorOptions options;
  options.max_open = 3;
  Bench bench({}, options);
  for (std::uint64_t i = 1; i <= 5; ++i)
    bench.ask(i, "drive", kSlow);
  bench.step();
  EXPECT_EQ(bench.state(3), v1::GOAL_WAITING);
  EXPECT_EQ(bench.state(4), v1::GOAL_REFUSED);
  EXPECT_EQ(bench.status(5).code, v1::CODE_TOO_MANY);
  EXPECT_EQ(bench.status(5).reason, "too many goals: 3 are open already");
}

TEST(Executor, OfEqualsTheFirstIsUnderway) {
  Bench bench;
  bench.ask(2, "drive", kSlow);
  bench.begin(1, "go_to", kFar);
  EXPECT_EQ(bench.state(2), v1::GOAL_UNDERWAY);
  EXPECT_EQ(bench.state(1), v1::GOAL_WAITING);
  EXPECT_EQ(bench.status(1).reason,
            "waits for goal 1:2 (drive) of \"somebody\", which came first; with a "
            "priority of 1 it would go first");
  EXPECT_EQ(bench.status(1).waits_for, (GoalId{1, 2}));
  EXPECT_EQ(bench.status(2).waits_for, GoalId{});
  bench.dispose(2);
  bench.step();
  EXPECT_EQ(bench.state(2), v1::GOAL_CANCELED);
  EXPECT_EQ(bench.status(2).code, v1::CODE_DISPOSED);
  EXPECT_EQ(bench.state(1), v1::GOAL_UNDERWAY);
  EXPECT_EQ(bench.status(1).reason, "");
  EXPECT_EQ(bench.status(1).waits_for, GoalId{});
}

TEST(Executor, TheMoreImportantInterruptsAndTheOtherGoesOn) {
  Bench bench;
  bench.begin(1, "go_to", kFar);
  bench.step();
  bench.begin(2, "turn_to", {number("heading", 1.0)}, 5);
  EXPECT_EQ(bench.state(1), v1::GOAL_SUSPENDED);
  EXPECT_EQ(bench.status(1).code, v1::CODE_PREEMPTED);
  EXPECT_EQ(bench.status(1).reason,
            "interrupted by goal 1:2 (turn_to) of \"somebody\", which is more important (priority "
            "5 over 0)");
  EXPECT_EQ(bench.status(1).waits_for, (GoalId{1, 2}));
  for (const IntendedBehavior& behavior : bench.out.behaviors)
    EXPECT_TRUE(behavior.schema == "TurnTo" || behavior.schema == "Stop");
  bench.run(2, 100);
  EXPECT_EQ(bench.state(2), v1::GOAL_SUCCEEDED);
  EXPECT_EQ(bench.state(1), v1::GOAL_UNDERWAY);
  // Without a cycle of an empty intent.
  EXPECT_EQ(bench.out.behaviors.size(), 4U);
}

TEST(Executor, AChangedPriorityCounts) {
  Bench bench;
  bench.ask(1, "drive", kSlow);
  bench.begin(2, "drive", kSlow);
  bench.begin(2, "drive", kSlow, 1);
  EXPECT_EQ(bench.state(1), v1::GOAL_SUSPENDED);
  EXPECT_EQ(bench.state(2), v1::GOAL_UNDERWAY);
}

TEST(Executor, AStopEndsWhatCameBeforeItWhateverItsPriority) {
  Bench bench;
  bench.ask(1, "drive", kSlow);
  bench.ask(2, "go_to", kFar);
  bench.begin(3, "drive", kSlow, 1000);
  bench.step();
  ASSERT_EQ(bench.state(3), v1::GOAL_UNDERWAY);
  bench.ask(4, "stop", {}, -1000);
  bench.begin(5, "go_to", kFar);
  for (const std::uint64_t stopped : {1U, 2U, 3U}) {
    EXPECT_EQ(bench.state(stopped), v1::GOAL_CANCELED);
    EXPECT_EQ(bench.status(stopped).code, v1::CODE_STOPPED);
    EXPECT_EQ(bench.status(stopped).reason, "stopped by goal 1:4 (stop) of \"somebody\"");
    EXPECT_EQ(bench.status(stopped).waits_for, (GoalId{1, 4}));
  }
  EXPECT_EQ(bench.state(5), v1::GOAL_UNDERWAY) << "it came after the stop";
  EXPECT_EQ(bench.state(4), v1::GOAL_WAITING);
  bench.begin(6, "stop", {});
  EXPECT_EQ(bench.state(5), v1::GOAL_CANCELED);
  bench.step(20);
  EXPECT_EQ(bench.state(6), v1::GOAL_SUCCEEDED);
  EXPECT_EQ(bench.state(4), v1::GOAL_SUCCEEDED);  // a stop does not end another
  bench.begin(7, "go_to", kFar);
  EXPECT_EQ(bench.state(7), v1::GOAL_UNDERWAY);
}

constexpr v1::StopId kFirst{7, 1};
constexpr v1::StopId kSecond{7, 2};

TEST(Executor, AStopOfTheBridgeEndsAllGoalsThatDrive) {
  Bench bench;
  bench.ask(1, "drive", kSlow);
  bench.begin(2, "go_to", kFar, 9);
  bench.stop = kFirst;
  bench.step();
  for (const std::uint64_t stopped : {1U, 2U}) {
    EXPECT_EQ(bench.state(stopped), v1::GOAL_CANCELED);
    EXPECT_EQ(bench.status(stopped).code, v1::CODE_STOPPED);
    EXPECT_EQ(bench.status(stopped).reason, "stopped by a person: ask anew to have it done");
  }
  EXPECT_TRUE(bench.out.behaviors.empty());
  EXPECT_EQ(bench.executor.heeds(), kFirst);
  bench.begin(3, "drive", kSlow);
  EXPECT_EQ(bench.state(3), v1::GOAL_UNDERWAY) << "the same stop ends nothing later";
  bench.stop = kSecond;
  bench.step();
  EXPECT_EQ(bench.state(3), v1::GOAL_CANCELED);
}

TEST(Executor, AStopFromBeforeTheStartEndsNothing) {
  Bench bench;
  bench.ask(1, "drive", kSlow);
  bench.stop = kFirst;
  bench.stop_was_before = true;
  bench.step();
  EXPECT_EQ(bench.state(1), v1::GOAL_UNDERWAY);
  EXPECT_EQ(bench.executor.heeds(), kFirst);
}

TEST(Executor, AStopWhileTheServiceWasDownEndsItsGoals) {
  Memory memory;
  memory.work.epoch = 100;
  memory.work.heeds = kFirst;
  for (const v1::StopId& now : {kFirst, kSecond}) {
    Bench bench(memory);
    bench.ask(1, "drive", kSlow);
    bench.stop = now;
    bench.stop_was_before = true;
    bench.step();
    EXPECT_EQ(bench.state(1) == v1::GOAL_UNDERWAY, now == kFirst);
  }
}

// A goal "stop" asks the bridge, and ends when the bridge has confirmed it.
TEST(Executor, AGoalStopWaitsForTheBridge) {
  Bench bench;
  bench.confirms_stops = true;
  bench.ask(1, "drive", kSlow);
  bench.step(5);
  bench.begin(2, "stop", {});
  EXPECT_EQ(bench.state(1), v1::GOAL_CANCELED);
  ASSERT_EQ(bench.out.stop, "somebody");
  bench.executor.heed(kFirst);
  bench.step(4);
  EXPECT_EQ(bench.out.stop, std::nullopt);
  bench.step();
  ASSERT_EQ(bench.out.stop, "somebody") << "asked again";
  bench.executor.heed(kSecond);
  EXPECT_EQ(bench.state(2), v1::GOAL_UNDERWAY);
  bench.ask(3, "drive", kSlow);
  bench.stop = kSecond;
  bench.step(3);
  EXPECT_EQ(bench.state(2), v1::GOAL_SUCCEEDED);
  EXPECT_EQ(bench.state(3), v1::GOAL_UNDERWAY) << "it came after the stop";
  EXPECT_EQ(bench.executor.heeds(), kSecond);
}

// Otherwise the time at which a grant comes would decide whether the behaviors drive.
TEST(Executor, AnOverdueConfirmationDoesNotTakeBackALaterStop) {
  Bench bench;
  for (const v1::StopId& own : {kFirst, kSecond}) {
    bench.begin(own.number, "stop", {});
    bench.executor.heed(own);
  }
  bench.stop = kFirst;
  bench.step();
  EXPECT_EQ(bench.executor.heeds(), kSecond);
  bench.stop = kSecond;
  bench.step();
  EXPECT_EQ(bench.executor.heeds(), kSecond);
  // A foreign stop between two of our own counts until the bridge shows ours.
  for (const v1::StopId& shown : {v1::StopId{8, 1}, kSecond}) {
    bench.stop = shown;
    bench.step();
    EXPECT_EQ(bench.executor.heeds(), shown);
  }
}

TEST(Executor, AGoalStopThatNoBridgeConfirmsFails) {
  Bench bench;
  bench.confirms_stops = true;
  bench.stop = kFirst;
  bench.stop_was_before = true;
  bench.begin(2, "stop", {});
  bench.executor.heed(kSecond);
  bench.run(2, 1000);
  EXPECT_EQ(bench.state(2), v1::GOAL_FAILED);
  bench.step();
  EXPECT_EQ(bench.executor.heeds(), kFirst) << "as the bridge has it";
}

TEST(Executor, AStopEndsWhatAPersonHasInterrupted) {
  Bench bench;
  bench.begin(1, "drive", kSlow, 5);
  ASSERT_TRUE(bench.executor.interrupt(bench.out.nodes.at(0).id));
  bench.step();
  bench.begin(2, "stop", {});
  EXPECT_EQ(bench.state(1), v1::GOAL_CANCELED);
}

TEST(Executor, AnEmergencyStopEndsWhatDrivesAndWhatIsAskedMeanwhile) {
  Bench bench;
  bench.ask(1, "go_to", kFar, 7);
  bench.begin(2, "drive", kSlow);
  bench.estop = "button";
  bench.step();
  bench.begin(3, "go_to", kFar, 9);
  for (const std::uint64_t ended : {1U, 2U, 3U}) {
    EXPECT_EQ(bench.state(ended), v1::GOAL_CANCELED);
    EXPECT_EQ(bench.status(ended).code, v1::CODE_STOPPED);
    EXPECT_EQ(bench.status(ended).reason,
              "emergency stop, pressed by \"button\": ask anew once it is released");
  }
  EXPECT_TRUE(bench.out.behaviors.empty());
  bench.estop.clear();
  bench.step();
  EXPECT_TRUE(bench.out.behaviors.empty()) << "nothing goes on by itself";
  bench.begin(4, "drive", kSlow);
  EXPECT_EQ(bench.state(4), v1::GOAL_UNDERWAY);
}

TEST(Executor, ADeadlineCountsFromAcceptance) {
  Bench bench;
  bench.ask(1, "drive", kSlow);
  Goal goal = Bench::goal(2, "go_to", kFar);
  goal.deadline = 2.0;
  bench.write(goal);
  bench.run(2, 100, v1::GOAL_WAITING);
  EXPECT_EQ(bench.cycle, 21U);
  EXPECT_EQ(bench.state(2), v1::GOAL_FAILED);
  EXPECT_EQ(bench.status(2).code, v1::CODE_DEADLINE);
  EXPECT_EQ(bench.status(2).reason,
            "not done within its deadline of 2 s; it was waiting: waits for goal 1:1 (drive) of "
            "\"somebody\", which came first; with a priority of 1 it would go first");
  EXPECT_EQ(bench.status(2).elapsed, 2.0);
}

TEST(Executor, TheLossOfItsWriterEndsAGoalUnlessItIsToBeKept) {
  Bench bench;
  bench.ask(1, "drive", kSlow);
  Goal kept = Bench::goal(2, "drive", kSlow);
  kept.writer_lost = v1::WRITER_LOST_KEEP;
  bench.write(kept);
  bench.step();
  bench.lose_writer(1);
  bench.lose_writer(2);
  bench.lose_writer(3);  // unknown: nothing
  bench.step();
  EXPECT_EQ(bench.state(1), v1::GOAL_CANCELED);
  EXPECT_EQ(bench.status(1).code, v1::CODE_WRITER_LOST);
  EXPECT_EQ(bench.state(2), v1::GOAL_UNDERWAY);
}

TEST(Executor, ARepetitionChangesNothing) {
  Bench bench;
  bench.world.held = true;
  bench.begin(1, "go_to", {point("position", {2.0, 0.0, 0.0}, Frame::robot)});
  const std::vector<IntendedBehavior> before = bench.out.behaviors;
  bench.world.robot.pose_in_odom = {1.0, 0.0, 0.0};
  bench.begin(1, "go_to", {point("position", {2.0, 0.0, 0.0}, Frame::robot)});
  EXPECT_EQ(bench.out.behaviors, before);
  EXPECT_EQ(bench.status(1).code, v1::CODE_NONE);
}

TEST(Executor, AChangeGoesOnWithoutBeginningAnew) {
  Bench bench;
  bench.ask(1, "go_to", {point("position", {2.0, 0.0, 0.0})});
  bench.step(10);
  const std::vector<IntendedBehavior> before = bench.out.behaviors;
  bench.begin(1, "go_to", {point("position", {0.0, 3.0, 0.0}), number("speed", 0.2)});
  EXPECT_EQ(bench.state(1), v1::GOAL_UNDERWAY);
  EXPECT_EQ(bench.status(1).code, v1::CODE_CHANGED);
  EXPECT_EQ(bench.status(1).step, "driving to (0.00, 3.00)");
  ASSERT_EQ(bench.out.behaviors.size(), before.size());
  EXPECT_EQ(bench.out.behaviors[2].name, before[2].name);
  EXPECT_EQ(find(bench.out.behaviors[2].parameters, "goal")->point, (Pose{0.0, 3.0, 0.0}));
  EXPECT_EQ(find(bench.out.behaviors[2].parameters, "speed")->number, 0.2);
  EXPECT_EQ(bench.status(1).elapsed, 1.0);
  bench.run(1, 400);
  EXPECT_EQ(bench.state(1), v1::GOAL_SUCCEEDED);
  EXPECT_LE((bench.world.robot.pose_in_odom.position() - Vec2(0.0, 3.0)).norm(), 0.15);
}

TEST(Executor, AChangeOfTheFunctorBeginsAnew) {
  Bench bench;
  bench.begin(1, "go_to", kFar);
  bench.begin(1, "drive", kSlow);
  EXPECT_EQ(bench.state(1), v1::GOAL_UNDERWAY);
  EXPECT_EQ(bench.status(1).functor, "drive");
  EXPECT_EQ(bench.out.behaviors.at(1).schema, "ConstantVelocity");
}

// Also for a goal that waits, or waits for a robot, and has its own reason.
TEST(Executor, ARefusedChangeIsToldUntilItIsTakenBack) {
  Bench bench;
  const std::string refused =
      "the change was refused: argument \"position\": expected a point x,y or x,y,heading, such as "
      "3,1, within 10000 m, got 3";
  bench.ask(1, "go_to", kFar);
  bench.begin(2, "go_to", kFar);
  const std::vector<IntendedBehavior> before = bench.out.behaviors;
  for (const std::uint64_t id : {1U, 2U})
    bench.ask(id, "go_to", {number("position", 3.0)});
  bench.step();
  EXPECT_EQ(bench.out.behaviors, before);
  EXPECT_EQ(bench.state(1), v1::GOAL_UNDERWAY);
  EXPECT_EQ(bench.status(1).reason, "goes on unchanged, " + refused);
  EXPECT_EQ(bench.status(2).reason,
            "waits for goal 1:1 (go_to) of \"somebody\", which came first; with a priority of 1 it "
            "would go first; " +
                refused);
  EXPECT_EQ(bench.status(2).waits_for, (GoalId{1, 1}));
  for (const std::uint64_t id : {1U, 2U})
    EXPECT_EQ(bench.status(id).code, v1::CODE_BAD_ARGUMENT);
  bench.world.robot.connected = false;
  bench.step();
  EXPECT_EQ(bench.status(1).reason, "the robot is not connected; goes on when it is; " + refused);
  EXPECT_EQ(bench.status(2).reason, "waits for the robot; " + refused);
  EXPECT_EQ(bench.status(2).code, v1::CODE_NO_ROBOT);
  EXPECT_EQ(bench.status(2).waits_for, GoalId{});
  bench.ask(1, "go_to", kFar);
  bench.begin(2, "drive", kSlow);
  EXPECT_EQ(bench.status(1).reason, "the robot is not connected; goes on when it is");
  EXPECT_EQ(bench.status(2).reason, "waits for the robot");
}

TEST(Executor, AnEndedGoalIsKeptForAMinute) {
  Bench bench;
  bench.ask(1, "stop", {});
  bench.step(4);
  ASSERT_EQ(bench.state(1), v1::GOAL_SUCCEEDED);
  bench.step(599);
  EXPECT_EQ(bench.statuses.count(1), 1U);
  bench.step();
  EXPECT_EQ(bench.statuses.count(1), 0U);
  // Its id stays used after that.
  bench.begin(1, "drive", kSlow);
  EXPECT_EQ(bench.state(1), v1::GOAL_SUCCEEDED);
  EXPECT_TRUE(bench.out.behaviors.empty());
}

// Without a robot no time passes, and a requester may send goals without end.
TEST(Executor, SoManyEndedGoalsAreKept) {
  ExecutorOptions options;
  options.max_shown = 3;
  Bench bench({}, options);
  for (std::uint64_t id = 1; id <= 8; ++id)
    bench.ask(id, "fly", {});
  bench.hear();
  EXPECT_EQ(bench.statuses.size(), 8U) << "each has been told";
  bench.ask(9, "fly", {});
  bench.hear();
  bench.hear();
  ASSERT_EQ(bench.statuses.size(), 3U);
  EXPECT_EQ(bench.statuses.begin()->first, 7U) << "the oldest are gone";
  bench.ask(1, "fly", {});
  bench.hear();
  EXPECT_EQ(bench.state(1), v1::GOAL_REFUSED);
  bench.step();
  EXPECT_EQ(bench.statuses.size(), 3U);
}

TEST(Executor, PublishesOnChangeAndOnceASecond) {
  Bench bench;
  bench.ask(1, "drive", kSlow);
  bench.step(101);
  EXPECT_EQ(bench.published, 11U);
}

TEST(Executor, HearsWithoutARobot) {
  Bench bench;
  bench.ask(1, "go_to", {point("position", {2.0, 0.0, 0.0}, Frame::robot)});
  bench.ask(2, "fly", {});
  bench.hear();
  EXPECT_EQ(bench.state(1), v1::GOAL_WAITING);
  EXPECT_EQ(bench.status(1).code, v1::CODE_NO_ROBOT);
  EXPECT_EQ(bench.status(1).reason, "accepted; waits for the robot");
  EXPECT_EQ(bench.state(2), v1::GOAL_REFUSED);
  // The point is from where the robot is when it is there.
  bench.world.robot.pose_in_odom = {0.0, 5.0, kPi};
  bench.step();
  EXPECT_EQ(bench.state(1), v1::GOAL_UNDERWAY);
  EXPECT_NEAR(find(bench.out.behaviors.at(2).parameters, "goal")->point.x, -2.0, 1e-12);
}

TEST(Executor, HearingBetweenCyclesOrWithThemIsTheSame) {
  Bench between;
  Bench with;
  for (Bench* bench : {&between, &with})
    bench->step();
  for (Bench* bench : {&between, &with}) {
    bench->ask(1, "drive", kSlow);
    bench->ask(2, "go_to", {point("position", {1.0, 1.0, 0.0}, Frame::robot)}, 1);
  }
  between.hear();
  for (int i = 0; i < 200; ++i) {
    between.step();
    with.step();
    ASSERT_EQ(between.out.behaviors, with.out.behaviors) << i;
    ASSERT_EQ(between.statuses, with.statuses) << i;
  }
}

TEST(Executor, GoalsWaitForARobotThatIsGone) {
  Bench bench;
  bench.ask(1, "go_to", kFar);
  bench.begin(2, "drive", kSlow);
  bench.note(bench.executor.robot_gone());
  EXPECT_EQ(bench.state(1), v1::GOAL_SUSPENDED);
  EXPECT_EQ(bench.status(1).code, v1::CODE_NO_ROBOT);
  EXPECT_EQ(bench.state(2), v1::GOAL_WAITING);
  EXPECT_EQ(bench.status(2).reason, "waits for the robot");
  // Another connection to the same robot, with the same odom frame.
  bench.epoch = 101;
  bench.cycle = 0;
  bench.step();
  EXPECT_EQ(bench.state(1), v1::GOAL_UNDERWAY);
  EXPECT_EQ(bench.out.behaviors.size(), 4U);
}

TEST(Executor, NothingIsIntendedForARobotThatIsNotConnected) {
  Bench bench;
  bench.begin(1, "go_to", kFar);
  bench.world.robot.connected = false;
  bench.step();
  EXPECT_EQ(bench.state(1), v1::GOAL_SUSPENDED);
  EXPECT_TRUE(bench.out.behaviors.empty());
  bench.world.robot.connected = true;
  bench.step();
  EXPECT_EQ(bench.state(1), v1::GOAL_UNDERWAY);
}

TEST(Executor, ALostPositionFailsWhatDependsOnIt) {
  Bench bench;
  bench.ask(1, "go_to", kFar);
  bench.ask(2, "go_to", {point("position", {2.0, 0.0, 0.0}, Frame::robot)});
  bench.ask(3, "turn_to", {number("heading", 1.0)});
  bench.begin(4, "drive", kSlow);
  bench.note(bench.executor.robot_gone());
  bench.ask(5, "go_to", kFar);  // odom is still the old one for all programs
  bench.ask(6, "go_to", {point("position", {2.0, 0.0, 0.0}, Frame::robot)});
  bench.hear();
  bench.epoch = 101;
  bench.cycle = 0;
  bench.world.robot.odom = 2;
  bench.step();
  for (const std::uint64_t lost : {1U, 2U, 3U, 5U}) {
    EXPECT_EQ(bench.state(lost), v1::GOAL_FAILED) << lost;
    EXPECT_EQ(bench.status(lost).code, v1::CODE_NO_ROBOT);
    EXPECT_NE(bench.status(lost).reason.find("position lost"), std::string::npos);
  }
  EXPECT_EQ(bench.state(4), v1::GOAL_UNDERWAY);
  EXPECT_EQ(bench.state(6), v1::GOAL_WAITING);
}

TEST(Executor, ARestartGoesOnWithWhatWasUnderway) {
  Bench bench;
  Goal goal = Bench::goal(1, "go_to", {point("position", {3.0, 0.0, 0.0}, Frame::robot)});
  goal.deadline = 5.0;
  bench.write(goal);
  Goal second = Bench::goal(2, "drive", kSlow);
  bench.step();
  bench.write(second);
  bench.step(20);

  Bench again(bench.memory());
  again.world = bench.world;
  again.cycle = bench.cycle + 10;
  again.write(second);  // the order in which they come again does not matter
  again.write(goal);
  again.step();
  EXPECT_EQ(again.state(1), v1::GOAL_UNDERWAY);
  EXPECT_EQ(find(again.out.behaviors.at(2).parameters, "goal")->point, (Pose{3.0, 0.0, 0.0}));
  EXPECT_EQ(again.status(1).elapsed, 3.1);
  again.run(1, 100);
  EXPECT_EQ(again.status(1).code, v1::CODE_DEADLINE);
  EXPECT_EQ(again.cycle, 51U);
}

TEST(Executor, ARestartKnowsThatThePositionIsLost) {
  Bench bench;
  bench.begin(1, "go_to", {point("position", {3.0, 0.0, 0.0}, Frame::robot)});
  Bench again(bench.memory());
  again.world.robot.odom = 2;
  again.begin(1, "go_to", {point("position", {3.0, 0.0, 0.0}, Frame::robot)});
  EXPECT_EQ(again.state(1), v1::GOAL_FAILED);
}

TEST(Executor, TheTreeShowsWhatServesWhichGoal) {
  Bench bench;
  bench.begin(1, "drive", kSlow);
  bench.begin(2, "drive", kSlow, 1);
  ASSERT_EQ(bench.out.nodes.size(), 5U);
  EXPECT_EQ(bench.out.nodes[0].state, IntentionState::kSuspended);
  EXPECT_EQ(bench.out.nodes[0].goal, (GoalId{1, 1}));
  EXPECT_EQ(bench.out.nodes[1].schema, "drive");
  EXPECT_EQ(bench.out.nodes[1].step, "driving at 0.10 m/s");
  EXPECT_EQ(bench.out.nodes[2].parent, bench.out.nodes[1].id);
  EXPECT_EQ(bench.out.nodes[2].goal, (GoalId{1, 2}));
  EXPECT_EQ(bench.out.behaviors[0].intention, bench.out.nodes[2].id);
}

}  // namespace
}  // namespace saphira::intentions
