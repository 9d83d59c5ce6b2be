#include "saphira/agent_interface/tasks.hpp"

#include <gtest/gtest.h>

#include "only.hpp"
#include "saphira/base/archive.hpp"

namespace saphira::agent_interface {
namespace {

Task errand(const std::string& speaker, const std::string& name) {
  Task task;
  task.goal.functor = "deliver";
  task.goal.lasting = true;
  task.goal.speaker = speaker;
  task.what = "I bring " + name;
  task.doing = "bringing " + name;
  task.name = name;
  return task;
}

Task motion(const std::string& speaker, const std::string& functor = "turn_to") {
  Task task;
  task.goal.functor = functor;
  task.goal.speaker = speaker;
  task.brief = true;
  task.what = functor == "stop" ? "I stop" : "I turn";
  task.name = "the turn";
  return task;
}

/// The open tasks, the newest first.
std::string doing(const Tasks& tasks) {
  std::string text;
  for (const Task& one : tasks.open())
    text = whole_text(one) + (text.empty() ? "" : "; ") + text;
  return text;
}

struct TasksTest : testing::Test {
  /// The robot's words with their listeners, the canceled goals, and the new ones with priorities.
  std::string told(const Tasks::Outputs& out) const {
    std::string all;
    for (const Said& one : out.said)
      all += one.listener + ": " + one.text + (one.end ? "." : "") + "\n";
    for (const std::uint64_t tag : out.canceled)
      all += "cancel " + std::to_string(tag) + "\n";
    for (const WantedGoal& goal : out.goals)
      all += "goal " + std::to_string(goal.tag) + " " + goal.functor + " " +
             std::to_string(goal.priority) + "\n";
    return all;
  }
  std::string want(std::vector<Task> steps, const std::string& speaker) {
    said = Utterance{{7, ++number}, speaker, "do it"};
    const Tasks::Outputs out = tasks.want(std::move(steps), said);
    asks = out.asks;
    return told(out);
  }

  Tasks tasks;
  Utterance said;
  std::vector<Task> asks;  ///< the newest question is about
  std::uint64_t number = 0;
};

TEST(GoalDeadline, LeavesTimeForTheAnswer) {
  EXPECT_DOUBLE_EQ(goal_deadline(1.5), 1.0);
  EXPECT_DOUBLE_EQ(goal_deadline(0.4), 0.2);
  EXPECT_EQ(goal_deadline(0.0), 0.0) << "without one";
}

TEST_F(TasksTest, AMotionInterruptsATaskWhichGoesOn) {
  EXPECT_EQ(want({errand("alice", "the mail")}, "alice"),
            "alice: I bring the mail\n"
            "goal 1 deliver 0\n");
  EXPECT_EQ(want({motion("bob")}, "bob"),
            "bob: I turn, and then I go on with the mail for alice\n"
            "goal 2 turn_to 1\n");
  EXPECT_EQ(doing(tasks), "I turn; I bring the mail");
  EXPECT_EQ(told(tasks.ended({2, true, "turned"})), "bob: done: turned.\n");
  EXPECT_EQ(told(tasks.ended({1, true, "brought"})), "alice: done: brought.\n");
  EXPECT_EQ(want({motion("bob")}, "bob"), "bob: I turn\ngoal 3 turn_to 0\n");
}

TEST_F(TasksTest, TheTasksOfAProgramEndWithItAndItsStopGoesOn) {
  const ProgramId model{1};
  const auto told_model = [&](std::vector<Task> steps) {
    Utterance words{{7, ++number}, "model", "do it"};
    words.program = model;
    return told(tasks.want(std::move(steps), words));
  };
  want({errand("alice", "the mail")}, "alice");
  told_model({motion("model"), motion("model")});
  EXPECT_EQ(told(tasks.left({2})), "") << "another program";
  // Its hold ends as well, and the task of alice goes on.
  EXPECT_EQ(
      told(tasks.left(model)),
      "model: I drop the turn, and the rest of the order: the program that wanted it has left or "
      "taken it back.\n"
      "cancel 2\n"
      "cancel 3\n");
  EXPECT_EQ(doing(tasks), "I bring the mail");
  EXPECT_EQ(told(tasks.left(model)), "");
  told_model({motion("model", "stop")});
  EXPECT_EQ(told(tasks.left(model)), "");
  EXPECT_EQ(doing(tasks), "I stop");
}

TEST_F(TasksTest, AMotionTakesThePlaceOfAnother) {
  want({errand("alice", "the mail")}, "alice");
  want({motion("bob")}, "bob");
  EXPECT_EQ(want({motion("carol")}, "carol"),
            "bob: I drop the turn for bob: carol said \"do it\".\n"
            "carol: I turn, and then I go on with the mail for alice\n"
            "cancel 2\n"
            "goal 3 turn_to 1\n");
  EXPECT_EQ(want({motion("Alice")}, "Alice"),
            "carol: I drop the turn for carol: Alice said \"do it\".\n"
            "Alice: I turn, and then I go on with the mail\n"
            "cancel 3\n"
            "goal 4 turn_to 1\n");
}

TEST_F(TasksTest, ATaskTakesThePlaceOfAnotherOfTheSamePerson) {
  want({errand("alice", "the mail")}, "alice");
  EXPECT_EQ(want({errand("Alice", "the book")}, "Alice"),
            "alice: I drop the mail.\n"
            "Alice: I bring the book\n"
            "cancel 1\n"
            "goal 2 deliver 0\n");
}

TEST_F(TasksTest, ForTheTaskOfSomebodyElseItAsks) {
  want({errand("alice", "the mail")}, "alice");
  EXPECT_EQ(want({errand("bob", "the book")}, "bob"),
            "bob: I am bringing the mail for alice. Shall I drop that?.\n");
  ASSERT_EQ(asks.size(), 1u);
  EXPECT_EQ(tasks.going_on("bob"), ": I go on with the mail for alice");
  EXPECT_EQ(tasks.going_on("alice"), ": I go on with the mail");
  EXPECT_EQ(told(tasks.want(asks, said, true)),
            "alice: I drop the mail for alice: bob said \"do it\".\n"
            "bob: I bring the book\n"
            "cancel 1\n"
            "goal 2 deliver 0\n");
  tasks.ended({2, true, "brought"});
  EXPECT_EQ(tasks.going_on("bob"), "");
}

TEST_F(TasksTest, AStopOfAnybodyEndsEverythingAndEachOwnerHearsIt) {
  want({errand("alice", "the mail")}, "alice");
  want({motion("bob")}, "bob");
  EXPECT_EQ(want({motion("bob", "stop")}, "bob"),
            "bob: I stop\n"
            "alice: I drop the mail for alice: bob said \"do it\".\n"
            "bob: I drop the turn.\n"
            "cancel 1\n"
            "cancel 2\n"
            "goal 3 stop 0\n");
  // The next task waits for the stop.
  EXPECT_EQ(want({errand("alice", "the mail")}, "alice"),
            "alice: I bring the mail\n"
            "goal 4 deliver 0\n");
  EXPECT_EQ(want({motion("bob", "stop")}, "bob"),
            "bob: I stop\n"
            "alice: I drop the mail for alice: bob said \"do it\".\n"
            "cancel 4\n"
            "goal 5 stop 0\n");
  EXPECT_EQ(told(tasks.ended({3, false, "canceled by a stop"})),
            "bob: done: I was told again to stop.\n");
  EXPECT_EQ(told(tasks.ended({5, true, "at rest"})), "bob: done: at rest.\n");
}

TEST_F(TasksTest, StepsAreDoneOneAfterAnother) {
  EXPECT_EQ(want({motion("bob"), errand("bob", "the mail")}, "bob"),
            "bob: I turn, and then I bring the mail\n"
            "goal 1 turn_to 0\n");
  EXPECT_EQ(doing(tasks), "I turn, and then I bring the mail");
  EXPECT_EQ(told(tasks.ended({1, true, "turned"})),
            "bob: done: turned\n"
            "bob: I bring the mail\n"
            "goal 2 deliver 0\n");
  EXPECT_EQ(told(tasks.ended({2, true, "brought"})), "bob: done: brought.\n");
  EXPECT_EQ(doing(tasks), "");
}

TEST_F(TasksTest, AStepThatFailsEndsTheRest) {
  want({motion("bob"), errand("bob", "the mail")}, "bob");
  EXPECT_EQ(told(tasks.ended({1, false, "the way is blocked"})),
            "bob: I could not: the way is blocked; so the rest is not done.\n");
  EXPECT_EQ(doing(tasks), "");
}

TEST_F(TasksTest, AStopEndsTheLaterStepsToo) {
  want({motion("bob"), motion("bob")}, "bob");
  EXPECT_EQ(want({motion("alice", "stop")}, "alice"),
            "alice: I stop\n"
            "bob: I drop the turn for bob, and the rest of the order: alice said \"do it\".\n"
            "cancel 1\n"
            "goal 2 stop 0\n");
  EXPECT_EQ(told(tasks.ended({1, false, "canceled"})), "");
}

TEST_F(TasksTest, BetweenBriefStepsTheRobotStandsAndTheTaskGoesOnAfterTheLast) {
  want({errand("alice", "the mail")}, "alice");
  EXPECT_EQ(want({motion("bob"), motion("bob")}, "bob"),
            "bob: I turn, and then I turn, and then I go on with the mail for alice\n"
            "goal 2 pause 1\n"
            "goal 3 turn_to 2\n");
  EXPECT_EQ(told(tasks.ended({3, true, "turned"})),
            "bob: done: turned\n"
            "bob: I turn\n"
            "goal 4 turn_to 2\n");
  EXPECT_EQ(told(tasks.ended({4, true, "turned"})),
            "bob: done: turned.\n"
            "cancel 2\n");
  want({motion("bob"), motion("bob")}, "bob");
  EXPECT_EQ(told(tasks.ended({6, false, "blocked"})),
            "bob: I could not: blocked; so the rest is not done.\n"
            "cancel 5\n");
  want({motion("bob"), motion("bob")}, "bob");
  EXPECT_EQ(want({motion("carol", "stop")}, "carol"),
            "carol: I stop\n"
            "alice: I drop the mail for alice: carol said \"do it\".\n"
            "bob: I drop the turn for bob, and the rest of the order: carol said \"do it\".\n"
            "cancel 1\n"
            "cancel 7\n"
            "cancel 8\n"
            "goal 9 stop 0\n");
}

TEST_F(TasksTest, LastingGoalsOutliveARestart) {
  want({errand("alice", "the mail")}, "alice");
  want({motion("alice")}, "alice");
  tasks.asked(1, {40, 2}, "{\"functor\":\"deliver\"}");
  const std::string kept = saved(tasks);
  auto restarted = restored<Tasks>(kept);
  EXPECT_EQ(restarted.lasting(), tasks.lasting());
  EXPECT_EQ(restarted.lasting().at(0).sample, "{\"functor\":\"deliver\"}");
  EXPECT_EQ(doing(restarted), "I bring the mail");
  EXPECT_EQ(restarted.spoken_for(), (UtteranceId{7, 1}));
  EXPECT_EQ(saved(restarted), kept);
  std::swap(tasks, restarted);
  EXPECT_EQ(want({errand("bob", "the book")}, "bob"),
            "bob: I am bringing the mail for alice. Shall I drop that?.\n");
  EXPECT_EQ(want({motion("bob")}, "bob"),
            "bob: I turn, and then I go on with the mail for alice\n"
            "goal 3 turn_to 1\n");
}

/// Checked identities, whatever the speakers call themselves.
struct OwnedTask : TasksTest {
  Tasks::Outputs want(std::vector<Task> steps, const Checked& person, bool drops = false) {
    Utterance words{{7, ++number}, "alice", "do it"};
    words.person = person;
    return tasks.want(std::move(steps), words, drops);
  }
  const Identity planner{"planner", "agent"};
  const Identity karen{"karen", "operator"};
  const Identity anna{"anna", "agent"};
};

TEST_F(OwnedTask, OnlyItsOwnerAndOperatorsReplaceIt) {
  want({errand("alice", "the mail")}, anna);
  const Tasks::Outputs denied = want({errand("alice", "the books")}, planner, true);
  EXPECT_FALSE(denied.denied.text.empty());
  EXPECT_TRUE(denied.goals.empty() && denied.canceled.empty() && denied.asks.empty());
  EXPECT_TRUE(test::only(denied.said).refused && test::only(denied.said).end);
  const Tasks::Outputs own = want({errand("alice", "the books")}, anna);
  EXPECT_EQ(own.canceled, std::vector<std::uint64_t>{1});
  EXPECT_EQ(test::only(own.goals).person, anna);
  EXPECT_EQ(want({errand("alice", "the mail")}, karen).canceled, std::vector<std::uint64_t>{2});
}

TEST_F(OwnedTask, AMotionInterruptsItAndIsItselfOwned) {
  want({errand("alice", "the mail")}, anna);
  EXPECT_EQ(want({motion("alice")}, planner).goals.size(), 1U);
  EXPECT_FALSE(want({motion("alice")}, anna).denied.text.empty());
  EXPECT_EQ(want({motion("alice")}, planner).canceled, std::vector<std::uint64_t>{2});
}

TEST_F(OwnedTask, AnybodyStopsItAndWhoGoesOnOwnsIt) {
  want({errand("alice", "the mail"), errand("alice", "the books")}, karen);
  const Tasks::Outputs stop = want({motion("alice", "stop")}, planner);
  EXPECT_EQ(stop.canceled, std::vector<std::uint64_t>{1});
  EXPECT_EQ(test::only(stop.goals).person, planner);
  tasks.ended({2, true, "stopped"});
  Utterance words{{7, ++number}, "alice", "go on"};
  words.person = planner;
  const Tasks::Outputs again = tasks.go_on(words);
  EXPECT_EQ(test::only(again.goals).person, planner) << "not in the name of who was stopped";
  const Tasks::Outputs next = tasks.ended({3, true, "brought"});
  EXPECT_EQ(test::only(next.goals).person, planner);
}

TEST_F(OwnedTask, AWaitEndsForItsOwnerAndOperators) {
  want({motion("alice", "pause")}, karen);
  Utterance words{{7, ++number}, "alice", "go on"};
  words.person = anna;
  EXPECT_FALSE(tasks.go_on(words).denied.text.empty());
  words.person = karen;
  EXPECT_EQ(tasks.go_on(words).canceled, std::vector<std::uint64_t>{1});
}

TEST_F(OwnedTask, KeepsItsOwnerOverARestart) {
  want({errand("alice", "the mail")}, anna);
  tasks.asked(1, {40, 2}, "sample");
  const std::string kept = saved(tasks);
  tasks = restored<Tasks>(kept);
  EXPECT_EQ(saved(tasks), kept);
  EXPECT_FALSE(want({errand("alice", "the books")}, planner, true).denied.text.empty());
  EXPECT_TRUE(want({errand("alice", "the books")}, anna).denied.text.empty());
}

}  // namespace
}  // namespace saphira::agent_interface
