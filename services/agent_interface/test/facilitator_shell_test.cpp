#include "agent_interface/shell/facilitator_shell.hpp"

#include <gtest/gtest.h>

#include "node_options.hpp"
#include "only.hpp"
#include "process.hpp"
#include "saphira/bus/agent.hpp"

namespace saphira::agent_interface {
namespace {

/// The facilitator with an agent and an asker, on a bus in memory, with a clock that the test
/// moves.
class FacilitatorInMemory : public testing::Test {
 protected:
  FacilitatorInMemory() {
    restart();
    worker.can(bus::action("sweep", "sweeps the floor", {}), [&](const v1::Request& request) {
      begun.push_back(request.number);
      begun_request = request;
      return v1::Answer{.code = v1::ANSWER_UNDERWAY, .text = "sweeps"};
    });
    worker.when_withdrawn([&](const v1::Request& request) {
      stopped.push_back(request.number);
      v1::Answer end{.code = v1::ANSWER_GIVEN_UP, .text = "half of the floor is clean"};
      worker.answer(request, end);
    });
  }
  /// The facilitator is killed, and comes back with its memory.
  void restart() {
    facilitator.reset();
    hub.emplace(test::memory_options("facilitator"), memory);
    facilitator = std::make_unique<FacilitatorShell>(*hub, now, folder.path("memory"));
  }
  /// Every program takes its samples.
  void turn() {
    for (int i = 0; i < 3; ++i) {
      facilitator->step(now += 0.01);
      worker.poll();
    }
  }
  static v1::Request sweep() { return v1::Request{.functor = "sweep"}; }

  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  std::optional<bus::Node> hub;
  bus::Node other{test::memory_options("sweeper"), memory};
  bus::Node person{test::memory_options("person"), memory};
  double now = 10.0;
  test::TempDir folder;
  std::unique_ptr<FacilitatorShell> facilitator;
  bus::Agent worker{other, "sweeper", "sweeps"};
  std::vector<std::uint64_t> begun;
  v1::Request begun_request;  // the newest
  std::vector<std::uint64_t> stopped;
};

TEST_F(FacilitatorInMemory, AnAgentStopsWhatIsWithdrawn) {
  bus::RequestClient asker(person, bus::topics::kSolve, "a person");
  std::vector<v1::Answer> answers;
  const std::uint64_t number =
      asker.send(sweep(), [&](const v1::Answer& answer) { answers.push_back(answer); });
  turn();
  EXPECT_EQ(begun, std::vector<std::uint64_t>{number});
  asker.withdraw(number);
  turn();
  EXPECT_EQ(stopped, begun);
  EXPECT_FALSE(worker.answer(begun_request, bus::done({}, "clean"))) << "it has ended";
  turn();
  asker.poll(now);
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].text, "sweeps");
  EXPECT_EQ(answers[1].code, v1::ANSWER_GIVEN_UP);
  EXPECT_EQ(answers[1].text, "half of the floor is clean");
}

TEST_F(FacilitatorInMemory, AnAgentIsRunningOnceItTakesRequests) {
  EXPECT_EQ(other.status().state, v1::SERVICE_STARTING);
  turn();
  EXPECT_EQ(other.status().state, v1::SERVICE_RUNNING);
}

TEST_F(FacilitatorInMemory, AnActionEndsWithTheWriterThatAskedForIt) {
  auto first = std::make_unique<bus::RequestClient>(person, bus::topics::kSolve, "a person");
  bus::RequestClient second(person, bus::topics::kSolve, "a person");  // of the same program
  const std::uint64_t number = first->send(sweep());
  second.send(sweep());
  turn();
  EXPECT_EQ(begun.size(), 2u);
  first.reset();
  turn();
  EXPECT_EQ(stopped, std::vector<std::uint64_t>{number});
}

TEST_F(FacilitatorInMemory, ARestartBeginsNoActionAgain) {
  bus::RequestClient asker(person, bus::topics::kSolve, "a person");
  std::string told;
  const std::uint64_t number =
      asker.send(sweep(), [&](const v1::Answer& answer) { told = answer.text; });
  turn();
  asker.poll(now);
  EXPECT_EQ(told, "sweeps");
  int swept = 0;
  bus::Agent broom(other, "broom", "comes first by its name");
  broom.can(bus::action("sweep", "sweeps the floor", {}), [&](const v1::Request&) {
    ++swept;
    return bus::done({});
  });
  facilitator.reset();
  hub.reset();
  asker.poll(now);
  restart();
  asker.poll(now);
  turn();
  broom.poll();
  EXPECT_EQ(swept, 0);
  EXPECT_EQ(begun, std::vector<std::uint64_t>{number});
  worker.answer(begun_request, bus::done({}, "clean"));
  turn();
  asker.poll(now);
  EXPECT_EQ(told, "clean");
}

TEST_F(FacilitatorInMemory, AnAgentThatWasSilentIsAskedAgainAndItsTriggersFire) {
  v1::Trigger trigger{.kind = v1::TRIGGER_EVENT, .condition = "dust", .action = "sweep"};
  worker.set(trigger);
  turn();
  bus::set_silent(*memory, "sweeper", true);
  turn();
  bus::RequestClient asker(person, bus::topics::kSolve, "a person");
  auto events = person.writer(bus::topics::kAgentEvents);
  v1::AgentEvent dust;
  dust.functor = "dust";
  events.write(dust);
  turn();
  EXPECT_EQ(begun.size(), 0u);
  bus::set_silent(*memory, "sweeper", false);
  turn();
  EXPECT_EQ(begun.size(), 0u) << "the event is over";
  const std::uint64_t number = asker.send(sweep());
  turn();
  EXPECT_EQ(begun, std::vector<std::uint64_t>{number});
  events.write(dust);
  turn();
  EXPECT_EQ(begun.size(), 2u);
}

TEST_F(FacilitatorInMemory, ATriggerLastsAsLongAsOneOfItsHolders) {
  v1::Trigger trigger{
      .id = {3, 1}, .kind = v1::TRIGGER_EVENT, .condition = "dust", .action = "sweep"};
  std::optional<bus::Writer<v1::Trigger>> first = person.writer(bus::topics::kTriggers);
  std::optional<bus::Writer<v1::Trigger>> second = other.writer(bus::topics::kTriggers);
  first->write(trigger);
  turn();
  second->write(trigger);
  turn();
  first->dispose(trigger);
  turn();
  worker.tell("dust", {});
  turn();
  EXPECT_EQ(begun.size(), 1u) << "the second still holds it";
  second.reset();
  turn();
  worker.tell("dust", {});
  turn();
  EXPECT_EQ(begun.size(), 1u);
  first->write(trigger);
  turn();
  worker.tell("dust", {});
  turn();
  EXPECT_EQ(begun.size(), 2u) << "it is set again";
  auto anybody = other.writer(bus::topics::kTriggers);
  anybody.dispose(trigger);
  turn();
  worker.tell("dust", {});
  turn();
  EXPECT_EQ(begun.size(), 2u) << "anybody may withdraw it";
}

/// With an activity that the robot can do.
struct TheRobotInMemory : FacilitatorInMemory {
  TheRobotInMemory() {
    v1::ActivitySchema schema{.name = "explore"};
    activities.write({.schemas = {schema}});
    turn();
  }
  bus::Writer<v1::ActivitySchemas> activities = person.writer(bus::topics::kActivitySchemas);
  bus::Reader<v1::Goal> goals = person.reader(bus::topics::kGoals);
};

TEST_F(TheRobotInMemory, AGoalThatLastsUntilItsDeadlineIsAnsweredInTime) {
  auto statuses = person.writer(bus::topics::kGoalStatus);
  bus::RequestClient asker(person, bus::topics::kSolve, "a person");
  v1::Request request{.functor = "explore", .deadline = 1.5};
  std::string told;
  asker.send(request, [&](const v1::Answer& answer) { told = answer.text; });
  turn();
  const auto asked = test::only(goals.take());
  EXPECT_NEAR(asked.data.deadline, 1.0, 1e-9);
  v1::GoalStatus status{.id = asked.data.id,
                        .state = v1::GOAL_SUCCEEDED,
                        .reason = "drove 0.10 m until the deadline"};
  now += 1.2;  // its deadline, and the way of the status
  statuses.write(status);
  turn();
  asker.poll(now);
  EXPECT_EQ(told, "drove 0.10 m until the deadline");
}

TEST_F(TheRobotInMemory, AGoalOfTheRobotEndsWithItsAsker) {
  auto asker = std::make_unique<bus::RequestClient>(person, bus::topics::kSolve, "a person");
  v1::Request request{.functor = "explore"};
  asker->send(request);
  turn();
  const auto asked = test::only(goals.take());
  EXPECT_FALSE(asked.info.disposed);
  asker.reset();
  turn();
  const auto ended = test::only(goals.take());
  EXPECT_TRUE(ended.info.disposed);
  EXPECT_EQ(ended.data.id, asked.data.id);
}

TEST_F(TheRobotInMemory, AGoalOfATriggerSaysThatTheProgramOfTheTriggerIsGone) {
  std::optional<bus::Writer<v1::Trigger>> triggers = other.writer(bus::topics::kTriggers);
  v1::Trigger trigger{.id = {3, 1}, .kind = v1::TRIGGER_TIME, .period = 1.0, .action = "explore"};
  triggers->write(trigger);
  turn();
  now += 1.0;
  turn();
  const auto asked = test::only(goals.take());
  triggers.reset();
  turn();
  const auto ended = test::only(goals.take());
  EXPECT_EQ(ended.data.id, asked.data.id);
  EXPECT_EQ(ended.data.withdrawn, "the program that set its trigger is gone");
}

}  // namespace
}  // namespace saphira::agent_interface
