#include "saphira/bus/goal_client.hpp"

#include <gtest/gtest.h>

#include <set>

#include "node_options.hpp"
#include "only.hpp"

namespace saphira::bus {
namespace {

using saphira::test::memory_options;
using saphira::test::only;

/// A service of goals, and an agent that asks for them.
class GoalClients : public testing::Test {
 protected:
  const std::shared_ptr<MemoryBus> bus_ = make_memory_bus();
  Node service_{memory_options("intentions"), bus_};
  Reader<v1::Goal> goals_ = service_.reader(topics::kGoals);
  Writer<v1::GoalStatus> statuses_ = service_.writer(topics::kGoalStatus);
  Node agent_{memory_options("agent"), bus_};
};

TEST_F(GoalClients, AsksChangesAndCancels) {
  GoalClient client(agent_, "an agent");
  v1::Goal goal{.functor = "stop"};
  const v1::GoalId id = client.ask(goal);
  EXPECT_TRUE(client.knows(id)) << "before its first status";
  EXPECT_FALSE(client.knows({.writer = 7, .number = 8}));
  EXPECT_TRUE(client.delivered(1000));
  auto heard = only(goals_.take());
  EXPECT_EQ(heard.data.id, id);
  EXPECT_EQ(heard.data.requester, "an agent");
  goal.priority = 3;
  goal.requester = "somebody else";
  client.change(id, goal);
  heard = only(goals_.take());
  EXPECT_EQ(heard.data.id, id);
  EXPECT_EQ(heard.data.priority, 3);
  EXPECT_EQ(heard.data.requester, "somebody else");
  client.cancel(id);
  heard = only(goals_.take());
  EXPECT_TRUE(heard.info.disposed);
  EXPECT_EQ(heard.data.id, id);
}

TEST_F(GoalClients, ACancelMayHaveAReasonAndTheGoalIsDisposedLater) {
  GoalClient client(agent_, "an agent", std::chrono::milliseconds(0));
  v1::Goal goal{.functor = "stop"};
  v1::GoalId foreign{.writer = 7, .number = 8};
  for (const v1::GoalId& id : {client.ask(goal), foreign}) {
    goals_.take();
    client.cancel(id, "it is late");
    auto heard = only(goals_.take());
    EXPECT_FALSE(heard.info.disposed);
    EXPECT_EQ(heard.data.id, id);
    EXPECT_EQ(heard.data.functor, id == foreign ? "" : "stop");
    EXPECT_EQ(heard.data.withdrawn, "it is late");
    client.poll();
    heard = only(goals_.take());
    EXPECT_TRUE(heard.info.disposed);
    EXPECT_EQ(heard.data.id, id);
  }
}

TEST(GoalClient, IsNotDeliveredWhereNobodyReads) {
  Node agent(memory_options("agent"), make_memory_bus());
  GoalClient client(agent, "an agent");
  client.ask(v1::Goal());
  EXPECT_FALSE(client.delivered(10));
}

TEST_F(GoalClients, KnowsTheNewestStatusAndKeepsItsOwn) {
  GoalClient client(agent_, "an agent");
  v1::GoalStatus own{.id = client.ask(v1::Goal())};
  v1::GoalStatus foreign{.id = {7, 8}};
  EXPECT_FALSE(client.status(own.id));
  for (v1::GoalStatus* const status : {&own, &foreign}) {
    statuses_.write(*status);
    status->state = v1::GOAL_SUCCEEDED;
    statuses_.write(*status);
  }
  client.poll();
  EXPECT_EQ(client.status(own.id)->state, v1::GOAL_SUCCEEDED);
  EXPECT_EQ(client.statuses().size(), 2U);
  // Withdrawn a minute after the end: the requester may still read the final state.
  statuses_.dispose(own);
  statuses_.dispose(foreign);
  client.poll();
  EXPECT_TRUE(client.status(own.id));
  EXPECT_FALSE(client.status(foreign.id));
}

TEST_F(GoalClients, TheNewestStatusIsTheLast) {
  GoalClient client(agent_, "an agent");
  for (const std::uint64_t number : {1U, 2U, 3U}) {
    statuses_.write({.id = {.writer = number}, .stamp = {number == 1 ? 8U : 7U, 100 - number}});
  }
  client.poll();
  std::vector<std::uint64_t> order;
  for (const v1::GoalStatus& status : client.statuses())
    order.push_back(status.id.writer);
  EXPECT_EQ(order, (std::vector<std::uint64_t>{3, 2, 1}));
}

// A program that is stopped for minutes misses the end, and the status is withdrawn meanwhile.
TEST_F(GoalClients, AGoalWhoseEndWasMissedIsOver) {
  GoalClient patient(agent_, "an agent");
  GoalClient hasty(agent_, "an agent", std::chrono::milliseconds(0));
  v1::GoalStatus never_heard{.id = hasty.ask(v1::Goal())};
  v1::GoalStatus told_again{.id = patient.ask(v1::Goal())};
  for (v1::GoalStatus* const status : {&never_heard, &told_again}) {
    status->state = v1::GOAL_UNDERWAY;
    statuses_.write(*status);
    statuses_.dispose(*status);
  }
  hasty.poll();
  ASSERT_TRUE(hasty.status(never_heard.id));
  EXPECT_EQ(hasty.status(never_heard.id)->state, v1::GOAL_FAILED);
  EXPECT_EQ(hasty.status(never_heard.id)->code, v1::CODE_FORGOTTEN);
  // A service that is started again tells the status anew.
  patient.poll();
  EXPECT_EQ(patient.status(told_again.id)->state, v1::GOAL_UNDERWAY);
  told_again.state = v1::GOAL_SUCCEEDED;
  statuses_.write(told_again);
  patient.poll();
  EXPECT_EQ(patient.status(told_again.id)->state, v1::GOAL_SUCCEEDED);
}

TEST_F(GoalClients, ForgetsWhatEndedLongAgo) {
  GoalClient client(agent_, "an agent", std::chrono::milliseconds(0));
  const v1::GoalId underway = client.ask(v1::Goal());
  const v1::GoalId done = client.ask(v1::Goal());
  const v1::GoalId canceled = client.ask(v1::Goal());
  EXPECT_EQ(goals_.take().size(), 3U);
  v1::GoalStatus status{.id = underway, .state = v1::GOAL_UNDERWAY};
  statuses_.write(status);
  status.id = done;
  status.state = v1::GOAL_SUCCEEDED;
  statuses_.write(status);
  client.cancel(canceled);
  EXPECT_EQ(goals_.take().size(), 1U);
  client.poll();
  EXPECT_TRUE(client.status(underway));
  EXPECT_FALSE(client.status(done));
  EXPECT_EQ(client.statuses().size(), 1U);
  const auto withdrawn = only(goals_.take());
  EXPECT_TRUE(withdrawn.info.disposed);
  EXPECT_EQ(withdrawn.data.id, done);
  // A forgotten goal is not withdrawn again.
  client.poll();
  EXPECT_TRUE(goals_.take().empty());
}

TEST_F(GoalClients, NoTwoGoalsHaveTheSameId) {
  GoalClient first(agent_, "first");
  GoalClient second(agent_, "second");
  GoalClient third(service_, "third");
  std::set<std::string> ids;
  for (int i = 0; i < 10; ++i) {
    for (GoalClient* const client : {&first, &second, &third})
      ids.insert(describe(client->ask(v1::Goal())));
  }
  EXPECT_EQ(ids.size(), 30U);
}

TEST(GoalClient, ReadsIdsAsItWritesThem) {
  v1::GoalId id{.writer = 0xfedcba9876543210ULL, .number = 18446744073709551615ULL};
  EXPECT_EQ(describe(id), "fedcba9876543210:18446744073709551615");
  EXPECT_EQ(parse_goal_id(describe(id)), id);
  for (const char* const wrong : {"", ":", "1", "1:", ":1", "x:1", "1:x", "1:2:3", " 1:2", "1:2 ",
                                  "-1:2", "10000000000000000:1"})
    EXPECT_FALSE(parse_goal_id(wrong)) << wrong;
}

TEST(GoalClient, TellsAStatusInALine) {
  v1::GoalStatus status{
      .state = v1::GOAL_UNDERWAY, .step = "driving", .progress = 0.25, .trend = v1::TREND_RISING};
  EXPECT_EQ(describe(status), "underway: driving (25 % done, level 0.00)");
  status.level = 0.25;
  EXPECT_EQ(describe(status), "underway: driving (25 % done)");
  status.state = v1::GOAL_SUSPENDED;
  status.step = "";
  status.reason = "interrupted";
  EXPECT_EQ(describe(status), "suspended [interrupted]");
  status.state = v1::GOAL_FAILED;
  status.reason = "no way";
  EXPECT_EQ(describe(status), "failed: no way");
}

TEST_F(GoalClients, ACancelNamesThePersonWhoWantsIt) {
  GoalClient client(agent_, "an agent");
  v1::Goal goal{.person = {"anna", "agent"}};
  const v1::GoalId id = client.ask(goal);
  auto heard = only(goals_.take());
  EXPECT_EQ(heard.data.person.name, "anna");
  client.cancel(id, "it is late", {"karen", "operator"});
  heard = goals_.take().at(0);
  EXPECT_EQ(heard.data.person.name, "karen");
}

// A program for people does not pass on what would drive their terminal.
TEST_F(GoalClients, ATerminalGetsNoControlCharactersOfOthers) {
  NodeOptions options = memory_options("cli");
  options.for_terminal = true;
  Node terminal(options, bus_);
  auto reader = terminal.reader(topics::kGoals);
  GoalClient client(agent_, "an\x1b[2Jagent");
  v1::Goal goal;
  goal.functor = "go\r\n\tto";
  goal.arguments = {text("place\x07",
                         "\xc2\x9b"
                         "31m")};
  goal.person.name = "\x7f";
  client.ask(goal);
  const auto raw = only(goals_.take());
  EXPECT_EQ(raw.data.functor, "go\r\n\tto");
  const auto shown = only(reader.take());
  EXPECT_EQ(shown.data.requester, "an?[2Jagent");
  EXPECT_EQ(shown.data.functor, "go?\n\tto");
  EXPECT_EQ(shown.data.arguments.at(0).name, "place?");
  EXPECT_EQ(shown.data.arguments.at(0).text, "\?\?31m");
  EXPECT_EQ(shown.data.person.name, "?");
  EXPECT_EQ(shown.data.id, raw.data.id);
  EXPECT_EQ(shown.info.writer, raw.info.writer);
}

}  // namespace
}  // namespace saphira::bus
