#include "saphira/intentions/core.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "saphira/intentions/functors.hpp"
#include "saphira/intentions/navigation.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::intentions {
namespace {

constexpr Core::Writer kKaren{1};
constexpr Core::Writer kJohn{2};

class CoreTest : public testing::Test {
 protected:
  explicit CoreTest(bool lockstep = false) : CoreTest(settings(lockstep)) {}
  explicit CoreTest(Core::Settings settings) : core_(std::move(settings)) {
    inputs_.stamp.epoch = 7;
    inputs_.robot.connected = true;
    inputs_.robot.odom = 1;
  }
  static Core::Settings settings(bool lockstep) {
    Core::Settings settings;
    settings.registry = built_in();
    settings.lockstep = lockstep;
    settings.functions = all_functions();
    return settings;
  }

  static Core::Received::Goal written(std::uint64_t number, const Core::Writer& writer) {
    Core::Received::Goal received;
    received.writer = writer;
    received.event.goal.id = {5, number};
    received.event.goal.functor = "go_to";
    received.event.goal.requester = "a test";
    Argument place;
    place.name = "position";
    place.kind = ArgumentKind::point;
    place.point = {5.0, 0.0, 0.0};
    place.frame = Frame::odom;
    received.event.goal.arguments = {place};
    return received;
  }

  static Core::Settings remembering(Memory memory) {
    Core::Settings made = settings(false);
    made.memory = std::move(memory);
    made.remembers_work = true;
    return made;
  }

  Core::Outputs step() { return step(core_); }
  Core::Outputs step(Core& core) {
    ++inputs_.stamp.cycle;
    inputs_.behaviors_cycle = inputs_.stamp.cycle - 1;
    const lps::LpsSettings robot;
    inputs_.new_robot = inputs_.stamp.cycle == 1 || is_new_ ? &robot : nullptr;
    is_new_ = false;
    core.processes().step(inputs_.stamp.cycle);
    Core::Outputs outputs = core.step(inputs_);
    inputs_.received = {};
    inputs_.maps.clear();
    inputs_.new_frame = false;
    note(outputs.intended.updates);
    return outputs;
  }
  Core::Outputs ask(std::vector<Core::Received::Goal> goals) {
    inputs_.received.goals = std::move(goals);
    return step();
  }
  void know(std::uint64_t revision, maps::Map map) {
    inputs_.maps.push_back({revision, std::make_shared<const maps::Map>(std::move(map))});
  }
  /// Between two cycles.
  std::vector<Note> look(const ActivityFolders::Reload& reload) {
    Core::Received received;
    received.activities = reload;
    return core_.between(received, 0.0).notes.lines();
  }
  void note(const GoalUpdates& updates) {
    for (const GoalStatus& status : updates.changed)
      statuses_[status.id] = status;
  }
  GoalState state(std::uint64_t number) { return statuses_.at({5, number}).state; }
  static bool says(const Notes& notes, const std::string& part) {
    return std::any_of(notes.lines().begin(), notes.lines().end(),
                       [&](const Note& note) { return note.text.find(part) != std::string::npos; });
  }

  Core core_;
  Core::Inputs inputs_;
  bool is_new_ = false;  ///< the core has not seen the robot
  std::map<GoalId, GoalStatus> statuses_;
};

TEST_F(CoreTest, PursuesAGoalAndTellsEachChangeOnce) {
  const Core::Outputs first = ask({written(1, kKaren)});
  EXPECT_FALSE(first.intended.behaviors.empty());
  EXPECT_EQ(state(1), v1::GOAL_UNDERWAY);
  EXPECT_TRUE(says(first.notes, "\"go_to\" of \"a test\": underway"));
  EXPECT_TRUE(step().notes.empty());
}

// The robot does not come nearer, since nobody drives it.
TEST_F(CoreTest, AGoalThatFailsSaysWhichServiceIsGone) {
  ask({written(1, kKaren)});
  step();
  const std::uint64_t heard = inputs_.behaviors_cycle;
  for (int i = 0; i < 1000 && !ended(state(1)); ++i) {
    ++inputs_.stamp.cycle;
    inputs_.behaviors_cycle = heard;
    inputs_.new_robot = nullptr;
    note(core_.step(inputs_).intended.updates);
    inputs_.received = {};
  }
  EXPECT_EQ(state(1), v1::GOAL_FAILED);
  EXPECT_NE(statuses_.at({5, 1}).reason.find("behaviors has not been heard for"), std::string::npos)
      << statuses_.at({5, 1}).reason;
}

// A minute at the stick is no minute without progress: the goal's patience (20 s) does not run.
TEST_F(CoreTest, AGoalThatDrivesWaitsForThePersonWhoHasTheRobot) {
  ask({written(1, kKaren)});
  inputs_.received.grants = {{false, "", "", "karen"}};
  EXPECT_TRUE(step().intended.behaviors.empty());
  EXPECT_EQ(state(1), v1::GOAL_SUSPENDED);
  EXPECT_EQ(statuses_.at({5, 1}).reason, "karen drives: goes on when the robot is handed back");
  inputs_.received.goals = {written(2, kJohn)};
  for (int i = 0; i < 600; ++i)
    step();
  EXPECT_EQ(state(1), v1::GOAL_SUSPENDED);
  EXPECT_EQ(state(2), v1::GOAL_WAITING);
  inputs_.received.grants = {{false, "", "", "", true}};
  EXPECT_TRUE(step().intended.behaviors.empty());
  EXPECT_EQ(statuses_.at({5, 1}).reason,
            "autonomy waits: goes on when the robot is handed back (saphira drive hand-back)");
  inputs_.received.grants = {{false, ""}};
  EXPECT_FALSE(step().intended.behaviors.empty());
  EXPECT_EQ(state(1), v1::GOAL_UNDERWAY);
}

TEST_F(CoreTest, AStopEndsGoalsThatWaitForAPerson) {
  inputs_.received.goals = {written(1, kKaren)};
  inputs_.received.grants = {{false, "", "", "karen"}};
  step();
  EXPECT_EQ(state(1), v1::GOAL_WAITING);
  Core::Received::Goal stop = written(2, kJohn);
  stop.event.goal.functor = "stop";
  stop.event.goal.arguments.clear();
  inputs_.received.goals = {stop};
  inputs_.own_stop = {7, 1};
  EXPECT_EQ(step().intended.stop, stop.event.goal.requester);
  EXPECT_EQ(core_.executor().heeds(), (v1::StopId{7, 1}));
  inputs_.received.grants.resize(1);
  inputs_.received.grants[0].stop = {7, 1};
  for (int i = 0; i < 5; ++i)
    step();
  EXPECT_EQ(state(1), v1::GOAL_CANCELED);
  EXPECT_EQ(state(2), v1::GOAL_SUCCEEDED);
}

TEST_F(CoreTest, AGoalEndsWithTheWriterThatWroteItLast) {
  ask({written(1, kKaren), written(2, kJohn)});
  inputs_.received.lost_requesters = {kKaren};
  step();
  EXPECT_EQ(state(1), v1::GOAL_CANCELED);
  EXPECT_FALSE(ended(state(2)));
  // Another writer has written it anew, and owns it from then on.
  ask({written(2, kKaren)});
  inputs_.received.lost_requesters = {kJohn};
  step();
  EXPECT_FALSE(ended(state(2)));
}

// On an open bus; the requester may be a person, for whom a program asks.
TEST_F(CoreTest, TheStatusOfAWithdrawnGoalSaysWhetherItsOwnProgramWithdrewIt) {
  const auto withdrawn = [&](const Core::Writer& asks, const Core::Writer& withdraws, bool gone) {
    static std::uint64_t number = 0;
    Core::Received::Goal goal = written(++number, asks);
    goal.event.goal.writer_lost = v1::WRITER_LOST_KEEP;
    ask({goal});
    if (gone)
      inputs_.received.lost_requesters = {asks};
    step();
    goal.event.kind = GoalEvent::Kind::kDisposed;
    goal.writer = withdraws;
    ask({goal});
    EXPECT_EQ(state(number), v1::GOAL_CANCELED);
    return statuses_.at({5, number}).reason;
  };
  EXPECT_EQ(withdrawn(kKaren, kKaren, false), "withdrawn by the program that asked for it");
  EXPECT_EQ(withdrawn(kKaren, kJohn, false), "withdrawn by another program");
  EXPECT_EQ(withdrawn(kKaren, kJohn, true), "withdrawn by a program")
      << "it may be the same program, which has slept";
}

// The rights of programs on a goal, on a bus that knows the writer of a sample.
class OwnedGoal : public CoreTest {
 protected:
  static constexpr auto kWritten = GoalEvent::Kind::kWritten;
  static constexpr auto kDisposed = GoalEvent::Kind::kDisposed;
  const Identity kKarenHerself{"karen", "agent"};
  const Identity kAgent{"john", "agent"};
  const Identity kOperator{"john", "operator"};
  const Identity kStranger{"", "agent"};

  static Core::Received::Goal by(const Identity& person, GoalEvent::Kind kind, int priority = 0) {
    Core::Received::Goal received = written(1, person.name == "karen" ? kKaren : kJohn);
    received.event.kind = kind;
    received.event.goal.priority = priority;
    received.event.goal.requester = "a test";
    received.person = person;
    return received;
  }
  Core::Outputs hear(const Core::Received::Goal& goal) {
    inputs_.received.goals = {goal};
    return step();
  }
  const GoalStatus& status() { return statuses_.at({5, 1}); }
};

TEST_F(OwnedGoal, AnotherMayNeitherChangeNorCancelIt) {
  hear(by(kKarenHerself, kWritten));
  ASSERT_EQ(state(1), v1::GOAL_UNDERWAY);
  EXPECT_TRUE(
      says(hear(by(kAgent, kDisposed)).notes,
           "\"karen (agent), a test\": john may not cancel it; its owner may, or an operator"));
  EXPECT_EQ(state(1), v1::GOAL_UNDERWAY);
  EXPECT_TRUE(hear(by(kAgent, kWritten, 7)).notes.lines().empty());  // one message is enough
  hear(by(kStranger, kDisposed));
  EXPECT_EQ(state(1), v1::GOAL_UNDERWAY);
  EXPECT_EQ(status().requester, "karen (agent), a test");
  EXPECT_NE(status().reason, "changed by its requester");
}

TEST_F(OwnedGoal, OperatorsHaveTheLastWordAboutPriority) {
  for (const int priority : {100, 101}) {
    Core core(settings(false));
    inputs_.stamp.cycle = 0;
    Core::Received::Goal agents = by(kAgent, kWritten);
    agents.event.goal.priority = 100000;
    Core::Received::Goal operators = by(kOperator, kWritten);
    operators.event.goal.id.number = 2;
    operators.event.goal.priority = priority;
    inputs_.received.goals = {agents, operators};
    step(core);
    EXPECT_EQ(state(2), priority > 100 ? v1::GOAL_UNDERWAY : v1::GOAL_WAITING);
  }
}

TEST_F(OwnedGoal, ItsOwnerMay) {
  hear(by(kKarenHerself, kWritten));
  hear(by(kKarenHerself, kWritten, 7));
  EXPECT_EQ(status().reason, "changed by its requester");
  hear(by(kKarenHerself, kDisposed));
  EXPECT_EQ(state(1), v1::GOAL_CANCELED);
  EXPECT_EQ(status().reason, "withdrawn by the program that asked for it");
  // Another program of hers.
  Core::Received::Goal second = by(kKarenHerself, kWritten);
  second.event.goal.id.number = 2;
  hear(second);
  second.event.kind = kDisposed;
  second.writer = kJohn;
  hear(second);
  EXPECT_EQ(statuses_.at({5, 2}).reason, "withdrawn by karen");
}

TEST_F(OwnedGoal, WhoCommandsMayAndIsNamed) {
  hear(by(kKarenHerself, kWritten));
  hear(by(kOperator, kWritten, 7));
  EXPECT_EQ(status().reason, "changed by john");
  EXPECT_EQ(status().requester, "karen (agent), a test");
  // The goal is still hers: it does not end with the other person's program.
  inputs_.received.lost_requesters = {kJohn};
  step();
  EXPECT_EQ(state(1), v1::GOAL_UNDERWAY);
  hear(by(kOperator, kDisposed));
  EXPECT_EQ(state(1), v1::GOAL_CANCELED);
  EXPECT_EQ(status().reason, "withdrawn by john");
}

// Goals of a model wait until a person approves them.
class ApprovedGoal : public CoreTest {
 protected:
  ApprovedGoal() : CoreTest(asking()) {}
  static Core::Settings asking() {
    Core::Settings made = settings(false);
    made.approval = {"", "language model", "guest"};
    return made;
  }
  static Core::Received::Goal of(const std::string& asker, std::uint64_t number) {
    Core::Received::Goal received = written(number, kKaren);
    received.event.goal.requester = asker;
    return received;
  }
  const GoalStatus& status(std::uint64_t number) { return statuses_.at({5, number}); }
  std::optional<std::string> approve(const std::string& goal) {
    return core_.ask(goal, ProcessAction::resume, 0);
  }
};

TEST_F(ApprovedGoal, WaitsForItsApprovalAndOthersDoNotWaitForIt) {
  ask({of("language model (by words)", 1), of("a program", 2)});
  EXPECT_EQ(state(1), v1::GOAL_WAITING);
  EXPECT_EQ(status(1).code, v1::CODE_APPROVAL);
  EXPECT_EQ(status(1).reason, "waits for a person's approval: saphira goal approve 5:1");
  EXPECT_EQ(state(2), v1::GOAL_UNDERWAY) << "it is behind nobody";
  EXPECT_EQ(approve("5:2"), "5:2 was not interrupted") << "its intention has its name";
  EXPECT_EQ(approve("5:3"), std::nullopt);
  EXPECT_EQ(approve("5:1"), "");
  Core::Received::Goal second = of("a program", 2);
  second.event.kind = GoalEvent::Kind::kDisposed;
  ask({second});
  EXPECT_EQ(state(1), v1::GOAL_UNDERWAY);
}

TEST_F(ApprovedGoal, NeedsAnotherApprovalForAnotherPlace) {
  ask({of("language model", 1)});
  EXPECT_EQ(approve("5:1"), "");
  step();
  ASSERT_EQ(state(1), v1::GOAL_UNDERWAY);
  ask({of("language model", 1)});
  EXPECT_EQ(state(1), v1::GOAL_UNDERWAY) << "the same once more";
  Core::Received::Goal farther = of("language model", 1);
  farther.event.goal.arguments[0].point.x = 9.0;
  ask({farther});
  EXPECT_EQ(state(1), v1::GOAL_SUSPENDED);
  EXPECT_EQ(status(1).code, v1::CODE_APPROVAL);
  EXPECT_TRUE(step().intended.behaviors.empty());
  EXPECT_EQ(approve("5:1"), "");
  step();
  EXPECT_EQ(state(1), v1::GOAL_UNDERWAY);
}

TEST_F(ApprovedGoal, ByRoleAndNeverAStop) {
  Core::Received::Goal guest = of("a program", 1);
  guest.person = Identity{"ann", "guest"};
  ask({guest});
  EXPECT_EQ(status(1).code, v1::CODE_APPROVAL);
  Core::Received::Goal stop = of("language model", 2);
  stop.event.goal.functor = "stop";
  stop.event.goal.arguments.clear();
  ask({stop});
  EXPECT_EQ(state(2), v1::GOAL_UNDERWAY);
  EXPECT_EQ(state(1), v1::GOAL_CANCELED);
}

// The dialogue asks for those whose words it has heard, and knows when their goals end.
TEST_F(OwnedGoal, TheProgramThatAskedForAnotherWithdrawsItAndASiblingDoesNot) {
  Core::Received::Goal goal = by(kKarenHerself, kWritten);
  goal.writer = kJohn;
  hear(goal);
  Core::Received::Goal end = by({"flakey", "services"}, kDisposed);
  end.writer = kKaren;
  hear(end);
  EXPECT_EQ(state(1), v1::GOAL_UNDERWAY);
  end.writer = kJohn;
  hear(end);
  EXPECT_EQ(state(1), v1::GOAL_CANCELED);
}

// A door is one program for several persons: it names who cancels.
TEST_F(OwnedGoal, APersonAtADoorDoesNotCancelThoseOfAnother) {
  Core::Received::Goal goal = by({"anna at flakey", "agent"}, kWritten);
  hear(goal);
  Core::Received::Goal end = by({"bob at flakey", "agent"}, kDisposed);
  end.event.why = "by bob";
  hear(end);
  EXPECT_EQ(state(1), v1::GOAL_UNDERWAY);
  end.person = Identity{"anna at flakey", "agent"};
  hear(end);
  EXPECT_EQ(state(1), v1::GOAL_CANCELED);
}

TEST_F(OwnedGoal, EachActIsInTheAuditOnce) {
  const auto acts = [&](const Core::Received::Goal& goal) {
    std::vector<v1::AuditAct> all;
    const Core::Outputs outputs = hear(goal);
    for (const v1::AuditEntry& entry : outputs.audit) {
      EXPECT_EQ(entry.who, goal.person->text() + ", a test");
      all.push_back(entry.act);
    }
    return all;
  };
  EXPECT_EQ(acts(by(kKarenHerself, kWritten)), std::vector{v1::AUDIT_ASKED});
  EXPECT_EQ(acts(by(kKarenHerself, kWritten)), std::vector<v1::AuditAct>{}) << "told once more";
  EXPECT_EQ(acts(by(kAgent, kWritten, 7)), std::vector{v1::AUDIT_REFUSED});
  EXPECT_EQ(acts(by(kAgent, kDisposed)), std::vector<v1::AuditAct>{}) << "one entry is enough";
  EXPECT_EQ(acts(by(kOperator, kWritten, 7)), std::vector{v1::AUDIT_CHANGED});
  EXPECT_EQ(acts(by(kOperator, kDisposed)), std::vector{v1::AUDIT_CANCELED});
}

TEST_F(CoreTest, BetweenCyclesGoalsAreHeardButNotBegun) {
  step();
  Core::Received received;
  received.goals = {written(1, kKaren)};
  received.goals[0].event.goal.functor = "fly";
  const Core::BetweenOutputs told = core_.between(received, 0.01);
  note(told.updates);
  EXPECT_EQ(state(1), v1::GOAL_REFUSED);
  EXPECT_TRUE(says(told.notes, "refused"));
}

TEST_F(CoreTest, AGoalThatFailsWhileTheBridgeRefusesSaysWhy) {
  inputs_.received.goals = {written(1, kKaren)};
  inputs_.received.goals[0].event.goal.deadline = 1.0;
  for (int i = 0; i < 20; ++i) {
    inputs_.received.grants = {{false, "", "a person drove last: autonomy waits"}};
    step();
  }
  ASSERT_EQ(state(1), v1::GOAL_FAILED);
  EXPECT_NE(statuses_.at({5, 1}).reason.find("; a person drove last: autonomy waits"),
            std::string::npos)
      << statuses_.at({5, 1}).reason;
}

TEST_F(CoreTest, WithoutMemoryAGoalOfBeforeTheStartIsNotDriven) {
  using Condition = Memory::Condition;
  for (const Condition condition : {Condition::kNone, Condition::kDamaged, Condition::kWhole}) {
    Memory memory;
    memory.condition = condition;
    memory.endings = {{{5, 3}, v1::GOAL_SUCCEEDED, v1::CODE_NONE, "arrived"}};
    Core core(remembering(memory));
    for (const std::uint64_t number : {1U, 2U, 3U}) {
      inputs_.received.goals.push_back(written(number, kKaren));
      inputs_.received.running = 1.0;
      inputs_.received.goals.back().age = number == 2 ? 3.0 : 61.0;
    }
    statuses_.clear();
    inputs_.stamp.cycle = 0;
    step(core);
    step(core);
    const bool whole = condition == Condition::kWhole;
    EXPECT_EQ(state(1), whole ? v1::GOAL_UNDERWAY : v1::GOAL_REFUSED);
    EXPECT_EQ(state(2), whole ? v1::GOAL_WAITING : v1::GOAL_UNDERWAY)
        << "programs of a deployment start together";
    EXPECT_EQ(state(3), v1::GOAL_SUCCEEDED) << "it is remembered";
    if (whole)
      continue;
    const GoalStatus& refused = statuses_.at({5, 1});
    EXPECT_EQ(refused.code, v1::CODE_FORGOTTEN);
    EXPECT_NE(refused.reason.find("60 s before intentions started"), std::string::npos)
        << refused.reason;
    EXPECT_EQ(refused.reason.find("damaged") != std::string::npos,
              condition == Condition::kDamaged);
    // A repeated request is another goal.
    inputs_.received.goals = {written(4, kKaren)};
    step(core);
    EXPECT_EQ(state(4), v1::GOAL_WAITING);
  }
}

TEST_F(CoreTest, TheAgeOfAGoalCountsOnlyInTheFirstSecondsAfterTheStart) {
  for (const auto& [number, running] : {std::pair(1U, 9.9), {2U, 10.0}}) {
    inputs_.received.running = running;
    inputs_.received.goals = {written(number, kKaren)};
    inputs_.received.goals[0].age = 60.0;
    step();
  }
  EXPECT_EQ(state(1), v1::GOAL_REFUSED);
  EXPECT_EQ(state(2), v1::GOAL_UNDERWAY);
}

TEST_F(CoreTest, ActivitiesOfFilesAreToldOfAfterTheFirstLook) {
  ActivityFolders::Reload updates;
  Schema wave = *built_in().find("stop");
  wave.name = "wave";
  wave.source = "wave.act";
  updates.taken = {wave};
  updates.errors = {"other.act:1:2: expected a name"};
  updates.warnings = {"wave.act:3: it is odd"};
  using Lines = std::vector<Note>;
  EXPECT_EQ(look(updates), (Lines{{Note::Level::error, "other.act:1:2: expected a name"}}));
  EXPECT_NE(core_.executor().registry().find("wave"), nullptr);
  EXPECT_EQ(look(updates), (Lines{{Note::Level::error, "other.act:1:2: expected a name"},
                                  {Note::Level::warning, "wave.act:3: it is odd"},
                                  {Note::Level::info, "took wave of wave.act"}}));
  updates = {};
  updates.removed = {"wave"};
  EXPECT_EQ(look(updates), (Lines{{Note::Level::info, "wave is gone: no file gives it any more"}}));
  EXPECT_EQ(core_.executor().registry().find("wave"), nullptr);
}

TEST_F(CoreTest, AfterASecondWithoutCyclesThereIsNoRobot) {
  ask({written(1, kKaren)});
  EXPECT_TRUE(core_.between({}, 0.9).updates.changed.empty());
  note(core_.between({}, 1.1).updates);
  EXPECT_EQ(statuses_.at({5, 1}).code, v1::CODE_NO_ROBOT);
  EXPECT_TRUE(core_.between({}, 5.0).updates.changed.empty()) << "it is told once";
  step();
  step();
  EXPECT_EQ(state(1), v1::GOAL_UNDERWAY);
}

TEST_F(CoreTest, AnEmergencyStopThatWasResetMeanwhileEndsGoalsAsWell) {
  ask({written(1, kKaren)});
  inputs_.received.grants = {{true, "button"}, {false, ""}};
  step();
  EXPECT_EQ(state(1), v1::GOAL_CANCELED);
  inputs_.received.grants = {{false, ""}};
  ask({written(2, kKaren)});
  EXPECT_EQ(state(2), v1::GOAL_UNDERWAY);
}

TEST_F(CoreTest, ASuspendedExecutionReleasesTheRobot) {
  ask({written(1, kKaren)});
  core_.processes().find("execute-intentions")->suspend();
  EXPECT_TRUE(step().intended.behaviors.empty());
  EXPECT_EQ(state(1), v1::GOAL_SUSPENDED);
  EXPECT_EQ(statuses_.at({5, 1}).reason, "execute-intentions is suspended");
  core_.processes().find("execute-intentions")->resume();
  step();
  EXPECT_FALSE(step().intended.behaviors.empty());
}

TEST_F(CoreTest, AnIntentionIsInterruptedByItsNameNumberOrSchema) {
  const IntentionNode node = ask({written(1, kKaren)}).intended.nodes.at(0);
  EXPECT_EQ(core_.ask(node.name, ProcessAction::interrupt, 0), "");
  EXPECT_TRUE(step().intended.behaviors.empty());
  EXPECT_EQ(core_.ask("I" + std::to_string(node.id), ProcessAction::resume, 0), "");
  EXPECT_FALSE(step().intended.behaviors.empty());
  EXPECT_EQ(core_.ask(node.name, ProcessAction::resume, 0), node.name + " was not interrupted");
  EXPECT_EQ(core_.ask("go_to", ProcessAction::interrupt, 0), "");
  EXPECT_EQ(core_.ask("go_to", ProcessAction::resume, 0), "");
  EXPECT_NE(core_.ask(node.name, ProcessAction::interrupt, 5).value_or("").find("until"),
            std::string::npos);
  EXPECT_EQ(core_.ask("nothing", ProcessAction::interrupt, 0), std::nullopt);
}

TEST_F(CoreTest, AClaimEndsWithItsWriterWhereItSaysSo) {
  const auto claim = [](std::uint64_t number, const char* name, bool ends) {
    Core::Received::Claim received;
    received.event.id = {9, number};
    received.event.source = "a person";
    received.event.name = name;
    received.event.value = Value(1.0);
    received.writer = kJohn;
    received.ends_with_writer = ends;
    return received;
  };
  const auto believes = [](const Core::Outputs& outputs, const std::string& name) {
    return outputs.beliefs &&
           std::any_of(outputs.beliefs->begin(), outputs.beliefs->end(),
                       [&](const Belief& belief) { return belief.name == name; });
  };
  inputs_.received.claims = {claim(1, "stays", false), claim(2, "goes", true)};
  Core::Outputs outputs = step();
  EXPECT_TRUE(believes(outputs, "stays"));
  EXPECT_TRUE(believes(outputs, "goes"));
  inputs_.received.lost_claimants = {kJohn};
  outputs = step();
  EXPECT_TRUE(believes(outputs, "stays"));
  EXPECT_FALSE(believes(outputs, "goes"));
}

TEST_F(CoreTest, AClaimOfBeforeTheStartKeepsItsAge) {
  struct Case {
    double running;  // [s] since the start
    double age;      // [s] of the claim
    Ticks old;       // the age that it counts with
  };
  for (const Case& one : {Case{2.0, 1.5, 0}, {2.0, 2.9, 0}, {2.0, 60.0, 600}, {11.0, 60.0, 0}}) {
    Core core(settings(false));
    inputs_.stamp.cycle = 0;
    Core::Received::Claim claim;
    claim.age = one.age;
    claim.event.id = {9, 1};
    claim.event.name = "given";
    claim.event.value = Value(1.0);
    inputs_.received.running = one.running;
    inputs_.received.claims = {claim};
    const Core::Outputs outputs = step(core);
    ASSERT_TRUE(outputs.beliefs);
    const auto given = std::ranges::find(*outputs.beliefs, "given", &Belief::name);
    ASSERT_NE(given, outputs.beliefs->end());
    EXPECT_EQ(given->since, -one.old) << one.running;
  }
}

TEST_F(CoreTest, AnEmergencyStopSaysWhichProgramPressedIt) {
  ask({written(1, kKaren)});
  inputs_.received.grants = {{true, "button"}};
  step();
  EXPECT_NE(statuses_.at({5, 1}).reason.find("button"), std::string::npos);
  inputs_.received.grants = {{false, ""}};
  ask({written(2, kKaren)});
  inputs_.received.grants = {{true, ""}};
  step();
  EXPECT_NE(statuses_.at({5, 2}).reason.find("a program without a name"), std::string::npos);
}

TEST_F(CoreTest, AStepFromRememberedGoalsGoesOnAsTheCoreBeforeIt) {
  Memory memory;
  const auto remember = [&](const GoalUpdates& updates) {
    memory.placements.insert(memory.placements.end(), updates.placed.begin(), updates.placed.end());
    memory.endings.insert(memory.endings.end(), updates.endings.begin(), updates.endings.end());
    if (updates.work)
      memory.work = *updates.work;
  };
  Core before(remembering({}));
  inputs_.received.goals = {written(1, kKaren), written(2, kKaren)};
  remember(step(before).intended.updates);
  inputs_.received.goals = {written(1, kKaren)};
  inputs_.received.goals[0].event.kind = GoalEvent::Kind::kDisposed;
  remember(step(before).intended.updates);
  ASSERT_TRUE(ended(state(1)));
  for (int i = 0; i < 3; ++i)
    remember(step(before).intended.updates);
  const Core::Outputs newest = step(before);
  remember(newest.intended.updates);
  ASSERT_FALSE(newest.intended.behaviors.empty());

  // The requesters' goals are latched: both come again. The link continues as well.
  Core next(remembering(memory));
  statuses_.clear();
  is_new_ = true;
  inputs_.received.goals = {written(1, kKaren), written(2, kKaren)};
  Core::Outputs outputs = step(next);
  for (int i = 0; i < 3 && outputs.intended.behaviors.empty(); ++i)
    outputs = step(next);
  EXPECT_TRUE(ended(state(1))) << "it is not done twice";
  EXPECT_EQ(state(2), v1::GOAL_UNDERWAY);
  ASSERT_EQ(outputs.intended.behaviors.size(), newest.intended.behaviors.size());
  for (std::size_t i = 0; i < outputs.intended.behaviors.size(); ++i)
    EXPECT_EQ(outputs.intended.behaviors[i].parameters, newest.intended.behaviors[i].parameters);
}

TEST_F(CoreTest, TheSameInputsGiveTheSameOutputs) {
  Core other(settings(false));
  for (int i = 1; i < 60; ++i) {
    inputs_.robot.pose_in_odom.x = 0.03 * i;
    if (i % 7 == 1)
      inputs_.received.goals = {
          written(static_cast<std::uint64_t>(i), i % 2 == 0 ? kKaren : kJohn)};
    if (i == 20)
      inputs_.received.lost_requesters = {kKaren};
    if (i == 30)
      inputs_.received.grants = {{true, "button"}, {false, ""}};
    if (i == 40) {
      ++inputs_.robot.odom;
      inputs_.new_frame = true;
    }
    const Core::Inputs same = inputs_;
    const Core::Outputs a = step();
    inputs_ = same;
    const Core::Outputs b = step(other);
    EXPECT_EQ(a.intended.behaviors, b.intended.behaviors) << i;
    EXPECT_EQ(a.intended.updates.changed, b.intended.updates.changed) << i;
    EXPECT_EQ(a.intended.updates.placed, b.intended.updates.placed) << i;
    EXPECT_EQ(a.intended.updates.endings, b.intended.updates.endings) << i;
    EXPECT_EQ(a.notes.lines(), b.notes.lines()) << i;
  }
  EXPECT_FALSE(statuses_.empty());
}

TEST_F(CoreTest, APlaceInPlaceOfAnActivityIsRefusedWithTheWayToGoThere) {
  const auto refusal = [&](std::uint64_t number, const std::string& functor) {
    Core::Received::Goal goal = written(number, kKaren);
    goal.event.goal.functor = functor;
    goal.event.goal.arguments.clear();
    ask({goal});
    EXPECT_EQ(state(number), v1::GOAL_REFUSED);
    return statuses_.at({5, number}).reason;
  };
  const std::string unknown = "there is no activity \"EJ-241\": saphira goal activities lists";
  Schema schema;
  schema.name = "go-to-place";
  look({true, {schema}, {}, {}, {}});
  EXPECT_EQ(refusal(1, "EJ-241").find(unknown), 0U) << "there is no map yet";
  maps::Map map;
  map.features.emplace_back();
  map.features[0].id = 7;
  map.features[0].type = lps::PointType::office;
  map.features[0].name = "EJ-241";
  know(1, map);
  step();
  EXPECT_EQ(refusal(2, "EJ-241"),
            "there is no activity \"EJ-241\", but a place of that name: did you mean go EJ-241?");
  EXPECT_EQ(refusal(3, "7").find("there is no activity \"7\": saphira goal activities"), 0U);
  look({true, {}, {"go-to-place"}, {}, {}});
  EXPECT_EQ(refusal(4, "EJ-241").find(unknown), 0U) << "no activity goes there";
}

TEST_F(CoreTest, APlaceThatTheMapDoesNotHaveIsRefusedAtOnce) {
  Parameter parameter;
  parameter.name = "place";
  parameter.kind = ArgumentKind::text;
  parameter.place = true;
  Schema schema;
  schema.name = "go-to-place";
  schema.parameters = {parameter};
  look({true, {schema}, {}, {}, {}});
  know(1, maps::parse_map("CORRIDOR (1) 5000, 0, 0, 10000, 2000 \"hall\"\n", "a.map"));
  step();
  Core::Received::Goal goal = written(1, kKaren);
  goal.event.goal.functor = "go-to-place";
  goal.event.goal.arguments = {text("place", "nowhere")};
  ask({goal});
  EXPECT_EQ(state(1), v1::GOAL_REFUSED);
  EXPECT_EQ(statuses_.at({5, 1}).reason, "the map has no place \"nowhere\": it has hall");
}

TEST_F(CoreTest, AGoalForAPointWhereNoGoalMayLeadIsRefusedAtOnceAndEndsNoOther) {
  know(1, maps::parse_map("CORRIDOR (1) 5000, 0, 0, 10000, 2000\n"
                          "ZONE (2) 8000, 0, 0, 2000, 2000 keep-out \"wet floor\"\n",
                          "a.map"));
  inputs_.robot.odom_in_map = Pose{};
  const auto to = [](std::uint64_t number, double x, double y) {
    Core::Received::Goal goal = written(number, kKaren);
    goal.event.goal.arguments[0].point = {x, y, 0.0};
    goal.event.goal.arguments[0].frame = Frame::map;
    return goal;
  };
  ask({to(1, 3.0, 0.0)});
  EXPECT_EQ(state(1), v1::GOAL_UNDERWAY);
  // Also between two cycles.
  Core::Received received;
  received.goals = {to(2, 8.0, 0.5), to(3, 5.0, 20.0)};
  note(core_.between(received, 0.0).updates);
  for (const std::uint64_t number : {2U, 3U}) {
    EXPECT_EQ(state(number), v1::GOAL_REFUSED);
    EXPECT_EQ(statuses_.at({5, number}).code, v1::CODE_NO_ROUTE);
  }
  EXPECT_EQ(statuses_.at({5, 2}).reason,
            "(8.00, 0.50) on the map is in keep-out zone \"wet floor\"");
  EXPECT_EQ(statuses_.at({5, 3}).reason,
            "(5.00, 20.00) on the map is in no room or corridor of the map");
  // A change to such a point leaves the goal as it was.
  ask({to(1, 8.0, 0.5)});
  EXPECT_EQ(state(1), v1::GOAL_UNDERWAY);
  EXPECT_EQ(statuses_.at({5, 1}).code, v1::CODE_NO_ROUTE);
}

TEST_F(CoreTest, TellsTheEdgesOfTheMapNearTheRobotInOdom) {
  know(1, maps::parse_map("CORRIDOR (1) 5000, 0, 0, 10000, 2000\n"
                          "OFFICE (2) 5000, 30000, 0, 4000, 4000\n",
                          "a.map"));
  inputs_.robot.odom_in_map = Pose{2.0, 0.5, 0.0};
  inputs_.registered.state = v1::REGISTRATION_LOST;
  EXPECT_TRUE(step().edges.empty()) << "its place is not sure";
  inputs_.registered.state = v1::REGISTRATION_TRACKING;
  const std::vector<Edge> edges = step().edges;
  ASSERT_EQ(edges.size(), 8U);
  EXPECT_NEAR(edges[0].from.y(), 0.5, 1e-9) << "the nearest first, in odom";
  EXPECT_NEAR(edges[0].to.y(), 0.5, 1e-9);
}

class InLockstep : public CoreTest {
 protected:
  InLockstep() : CoreTest(true) {}
};

// Plans must not depend on the map's time of arrival.
TEST_F(InLockstep, AMapCountsFromTheStepOnForWhichRegistrationHadIt) {
  const maps::Map hall = maps::parse_map("CORRIDOR (1) 5000, 0, 0, 10000, 2000\n", "a.map");
  inputs_.robot.odom_in_map = Pose{};
  inputs_.registered.state = v1::REGISTRATION_TRACKING;
  know(1, {});
  know(2, hall);
  inputs_.map_revision = 1;
  EXPECT_TRUE(step().edges.empty());
  know(4, {});
  EXPECT_TRUE(step().edges.empty());
  inputs_.map_revision = 3;  // which was skipped
  EXPECT_FALSE(step().edges.empty());
  inputs_.map_revision = 4;
  EXPECT_TRUE(step().edges.empty());
}

TEST_F(InLockstep, ASimulatorMayStandStillForAsLongAsItLikes) {
  ask({written(1, kKaren)});
  EXPECT_TRUE(core_.between({}, 100.0).updates.changed.empty());
}

}  // namespace
}  // namespace saphira::intentions
