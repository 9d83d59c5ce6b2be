#include "saphira/bus/goal_client.hpp"

#include <gtest/gtest.h>

#include <set>

namespace saphira::bus {
namespace {

NodeOptions named(const std::string& name) {
  NodeOptions options;
  options.name = name;
  return options;
}

TEST(GoalClient, AsksChangesAndCancels) {
  const auto bus = make_memory_bus();
  Node service(named("intentions"), bus);
  auto goals = service.reader(topics::kGoals);
  Node agent(named("agent"), bus);
  GoalClient client(agent, "an agent");
  v1::Goal goal;
  goal.functor("stop");
  const v1::GoalId id = client.ask(goal);
  EXPECT_TRUE(client.delivered(1000));
  auto heard = goals.take();
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(heard[0].data.id(), id);
  EXPECT_EQ(heard[0].data.requester(), "an agent");
  goal.priority(3);
  goal.requester("somebody else");
  client.change(id, goal);
  heard = goals.take();
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(heard[0].data.id(), id);
  EXPECT_EQ(heard[0].data.priority(), 3);
  EXPECT_EQ(heard[0].data.requester(), "somebody else");
  client.cancel(id);
  heard = goals.take();
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_TRUE(heard[0].info.disposed);
  EXPECT_EQ(heard[0].data.id(), id);
}

TEST(GoalClient, IsNotDeliveredWhereNobodyReads) {
  Node agent(named("agent"), make_memory_bus());
  GoalClient client(agent, "an agent");
  client.ask(v1::Goal());
  EXPECT_FALSE(client.delivered(10));
}

TEST(GoalClient, KnowsTheNewestStatusAndKeepsItsOwn) {
  const auto bus = make_memory_bus();
  Node service(named("intentions"), bus);
  auto statuses = service.writer(topics::kGoalStatus);
  Node agent(named("agent"), bus);
  GoalClient client(agent, "an agent");
  v1::GoalStatus own;
  own.id(client.ask(v1::Goal()));
  v1::GoalStatus foreign;
  foreign.id().writer(7);
  foreign.id().number(8);
  EXPECT_FALSE(client.status(own.id()));
  for (v1::GoalStatus* const status : {&own, &foreign}) {
    statuses.write(*status);
    status->state(v1::GOAL_SUCCEEDED);
    statuses.write(*status);
  }
  client.poll();
  EXPECT_EQ(client.status(own.id())->state(), v1::GOAL_SUCCEEDED);
  EXPECT_EQ(client.statuses().size(), 2U);
  // Withdrawn a minute after the end: the requester may still read the final state.
  statuses.dispose(own);
  statuses.dispose(foreign);
  client.poll();
  EXPECT_TRUE(client.status(own.id()));
  EXPECT_FALSE(client.status(foreign.id()));
}

// A program that is stopped for minutes misses the end, and the status is withdrawn meanwhile.
TEST(GoalClient, AGoalWhoseEndWasMissedIsOver) {
  const auto bus = make_memory_bus();
  Node service(named("intentions"), bus);
  auto statuses = service.writer(topics::kGoalStatus);
  Node agent(named("agent"), bus);
  GoalClient patient(agent, "an agent");
  GoalClient hasty(agent, "an agent", std::chrono::milliseconds(0));
  v1::GoalStatus never_heard;
  never_heard.id(hasty.ask(v1::Goal()));
  v1::GoalStatus told_again;
  told_again.id(patient.ask(v1::Goal()));
  for (v1::GoalStatus* const status : {&never_heard, &told_again}) {
    status->state(v1::GOAL_UNDERWAY);
    statuses.write(*status);
    statuses.dispose(*status);
  }
  hasty.poll();
  ASSERT_TRUE(hasty.status(never_heard.id()));
  EXPECT_EQ(hasty.status(never_heard.id())->state(), v1::GOAL_FAILED);
  EXPECT_EQ(hasty.status(never_heard.id())->code(), v1::CODE_FORGOTTEN);
  // A service that is started again tells the status anew.
  patient.poll();
  EXPECT_EQ(patient.status(told_again.id())->state(), v1::GOAL_UNDERWAY);
  told_again.state(v1::GOAL_SUCCEEDED);
  statuses.write(told_again);
  patient.poll();
  EXPECT_EQ(patient.status(told_again.id())->state(), v1::GOAL_SUCCEEDED);
}

TEST(GoalClient, ForgetsWhatEndedLongAgo) {
  const auto bus = make_memory_bus();
  Node service(named("intentions"), bus);
  auto goals = service.reader(topics::kGoals);
  auto statuses = service.writer(topics::kGoalStatus);
  Node agent(named("agent"), bus);
  GoalClient client(agent, "an agent", std::chrono::milliseconds(0));
  const v1::GoalId underway = client.ask(v1::Goal());
  const v1::GoalId done = client.ask(v1::Goal());
  const v1::GoalId canceled = client.ask(v1::Goal());
  EXPECT_EQ(goals.take().size(), 3U);
  v1::GoalStatus status;
  status.id(underway);
  status.state(v1::GOAL_UNDERWAY);
  statuses.write(status);
  status.id(done);
  status.state(v1::GOAL_SUCCEEDED);
  statuses.write(status);
  client.cancel(canceled);
  EXPECT_EQ(goals.take().size(), 1U);
  client.poll();
  EXPECT_TRUE(client.status(underway));
  EXPECT_FALSE(client.status(done));
  EXPECT_EQ(client.statuses().size(), 1U);
  const auto withdrawn = goals.take();
  ASSERT_EQ(withdrawn.size(), 1U);
  EXPECT_TRUE(withdrawn[0].info.disposed);
  EXPECT_EQ(withdrawn[0].data.id(), done);
  // A forgotten goal is not withdrawn again.
  client.poll();
  EXPECT_TRUE(goals.take().empty());
}

TEST(GoalClient, NoTwoGoalsHaveTheSameId) {
  const auto bus = make_memory_bus();
  Node one(named("one"), bus);
  Node two(named("two"), bus);
  GoalClient first(one, "first");
  GoalClient second(one, "second");
  GoalClient third(two, "third");
  std::set<std::string> ids;
  for (int i = 0; i < 10; ++i) {
    for (GoalClient* const client : {&first, &second, &third})
      ids.insert(describe(client->ask(v1::Goal())));
  }
  EXPECT_EQ(ids.size(), 30U);
}

TEST(GoalClient, ReadsIdsAsItWritesThem) {
  v1::GoalId id;
  id.writer(0xfedcba9876543210ULL);
  id.number(18446744073709551615ULL);
  EXPECT_EQ(describe(id), "fedcba9876543210:18446744073709551615");
  EXPECT_EQ(parse_goal_id(describe(id)), id);
  for (const char* const wrong : {"", ":", "1", "1:", ":1", "x:1", "1:x", "1:2:3", " 1:2", "1:2 ",
                                  "-1:2", "10000000000000000:1"})
    EXPECT_FALSE(parse_goal_id(wrong)) << wrong;
}

TEST(GoalClient, TellsAStatusInALine) {
  v1::GoalStatus status;
  status.state(v1::GOAL_UNDERWAY);
  status.step("driving");
  status.progress(0.25);
  EXPECT_EQ(describe(status), "underway: driving (25 % done, level 0.00)");
  status.state(v1::GOAL_SUSPENDED);
  status.step("");
  status.reason("interrupted");
  EXPECT_EQ(describe(status), "suspended [interrupted]");
  status.state(v1::GOAL_FAILED);
  status.reason("no way");
  EXPECT_EQ(describe(status), "failed: no way");
}

}  // namespace
}  // namespace saphira::bus
