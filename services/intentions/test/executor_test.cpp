// Goals where lines of goals.txt do not do.
#include "saphira/intentions/executor.hpp"

#include <gtest/gtest.h>

#include "bench.hpp"

namespace saphira::intentions {
namespace {

const Arguments kSlow = {number("speed", 0.1)};

TEST(Executor, OfALongReasonTheBeginningIsRemembered) {
  Bench bench;
  const Arguments wrong{text("position", std::string(300, 'x'))};
  bench.begin(1, "go_to", wrong);
  const std::string whole = bench.status(1).reason;
  ASSERT_GT(whole.size(), kLongestReason);
  Bench again(bench.memory);
  again.begin(1, "go_to", wrong);
  EXPECT_EQ(again.state(1), v1::GOAL_REFUSED);
  EXPECT_EQ(again.status(1).reason, whole.substr(0, kLongestReason - 3) + "...");
}

TEST(Executor, RefusesWhatIsTooManyOfOneProgramAndOfAll) {
  ExecutorOptions options;
  options.max_open = 4;
  options.max_open_of_one = 3;
  Bench bench({}, options);
  for (std::uint64_t i = 1; i <= 6; ++i) {
    Goal goal = bench.goal(i, "drive", kSlow);
    if (i > 4)
      ++goal.id.writer;
    bench.write(goal);
  }
  bench.step();
  EXPECT_EQ(bench.state(3), v1::GOAL_WAITING);
  EXPECT_EQ(bench.status(4).code, v1::CODE_TOO_MANY);
  EXPECT_EQ(bench.status(4).reason, "too many goals: 3 of this program are open already");
  EXPECT_EQ(bench.state(5), v1::GOAL_WAITING);
  EXPECT_EQ(bench.status(6).code, v1::CODE_TOO_MANY);
  EXPECT_EQ(bench.status(6).reason, "too many goals: 4 are open already");
}

constexpr v1::StopId kFirst{7, 1};
constexpr v1::StopId kSecond{7, 2};

TEST(Executor, AStopWhileTheServiceWasDownEndsItsGoals) {
  Memory memory;
  memory.work.epoch = 100;
  memory.work.heeds = kFirst;
  for (const v1::StopId& now : {kFirst, kSecond}) {
    Bench bench(memory);
    bench.ask(1, "drive", kSlow);
    bench.stop = now;
    bench.step();
    EXPECT_EQ(bench.state(1) == v1::GOAL_UNDERWAY, now == kFirst);
  }
}

// Killed after it wrote the ending, and before it wrote its work.
TEST(Executor, AnEndedGoalIsNotTakenUpAgain) {
  Bench before;
  before.begin(1, "drive", kSlow);
  ASSERT_EQ(before.memory.work.goals.size(), 1U);
  before.memory.endings = {{{1, 1}, v1::GOAL_SUCCEEDED, v1::CODE_NONE, "done"}};
  Bench bench(before.memory);
  bench.begin(1, "drive", kSlow);
  EXPECT_EQ(bench.state(1), v1::GOAL_SUCCEEDED);
  EXPECT_TRUE(bench.out.behaviors.empty());
  EXPECT_TRUE(bench.memory.work.goals.empty());
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
