#include "intentions/shell/shell.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "process.hpp"
#include "saphira/bus/goal_client.hpp"
#include "scripted_bus.hpp"

namespace saphira::intentions {
namespace {

bus::NodeOptions named(const std::string& name) {
  bus::NodeOptions options;
  options.name = name;
  options.lockstep = true;
  return options;
}

/// The service, a scripted robot and a requester on a bus within the process, in one thread.
class ShellTest : public testing::Test {
 protected:
  void start(const std::string& memory_file = {}) {
    service.emplace(named("intentions"), bus);
    shell.emplace(*service, ShellOptions{memory_file, false});
  }
  void kill() {
    shell.reset();
    service.reset();
  }
  void cycle() {
    robot.publish_state();
    // After a restart it first steps the cycles that it finds on the bus.
    bool acted = false;
    for (int i = 0; i < 8 && !acted; ++i) {
      ASSERT_TRUE(shell->step(stop));
      acted = robot.act();
    }
    ASSERT_TRUE(acted);
    goals.poll();
  }
  v1::GoalState state(const v1::GoalId& id) { return goals.status(id)->state(); }

  std::shared_ptr<bus::MemoryBus> bus = bus::make_memory_bus();
  bus::Stop stop;
  bus::Node robot_node{named("robot"), bus};
  bus::Node requester{named("requester"), bus};
  ScriptedBus robot{robot_node};
  bus::GoalClient goals{requester, "a test"};
  std::optional<bus::Node> service;
  std::optional<Shell> shell;
};

v1::Goal go_to(double x, double y) {
  v1::Goal goal;
  goal.functor("go_to");
  goal.arguments().push_back(bus::point("position", x, y, 0.0, v1::FRAME_ODOM));
  return goal;
}

TEST_F(ShellTest, DrivesToAGoalAndSaysSo) {
  start();
  const v1::GoalId id = goals.ask(go_to(1.0, 0.5));
  for (int i = 0; i < 100 && (!goals.status(id) || !bus::ended(state(id))); ++i)
    cycle();
  EXPECT_EQ(state(id), v1::GOAL_SUCCEEDED) << bus::describe(*goals.status(id));
  EXPECT_EQ(goals.status(id)->requester(), "a test");
  EXPECT_EQ(goals.status(id)->stamp().epoch(), robot.epoch);
  EXPECT_EQ(goals.status(id)->stamp().cycle(), robot.cycle);
  EXPECT_LE((robot.world.robot.pose_in_odom.position() - Vec2(1.0, 0.5)).norm(), 0.15);
  EXPECT_TRUE(robot.intended->behaviors().empty());
  EXPECT_TRUE(robot.intended->behavior_control());
}

TEST_F(ShellTest, PublishesTheTree) {
  start();
  goals.ask(go_to(1.0, 0.5));
  cycle();
  ASSERT_EQ(robot.intended->nodes().size(), 5U);
  EXPECT_EQ(robot.intended->nodes()[0].schema(), "go_to");
  EXPECT_EQ(robot.intended->nodes()[1].parent(), robot.intended->nodes()[0].id());
}

// Manual 6.5, and 2.3.8 for one intention alone.
TEST_F(ShellTest, HoldsAllGoalsWhileItIsSuspendedAndOneIntentionByItsName) {
  bus::Writer<v1::ProcessRequest> requests{requester.writer(bus::topics::kProcessRequest)};
  bus::Reader<v1::ProcessAnswer> answers{requester.reader(bus::topics::kProcessAnswer)};
  const auto request = [&](const std::string& process, v1::ProcessAction action) {
    v1::ProcessRequest sample;
    sample.source("a person");
    sample.service("intentions");
    sample.process(process);
    sample.action(action);
    requests.write(sample);
    cycle();
    return answers.take_newest().value().reason();
  };
  start();
  const v1::GoalId id = goals.ask(go_to(5.0, 0.0));
  cycle();
  EXPECT_FALSE(robot.intended->behaviors().empty());
  EXPECT_EQ(request("execute-intentions", v1::PROCESS_SUSPEND), "");
  EXPECT_TRUE(robot.intended->behaviors().empty());
  EXPECT_EQ(state(id), v1::GOAL_SUSPENDED);
  EXPECT_EQ(goals.status(id)->reason(), "execute-intentions is suspended");
  EXPECT_EQ(request("execute-intentions", v1::PROCESS_RESUME), "");
  cycle();
  EXPECT_FALSE(robot.intended->behaviors().empty());
  EXPECT_EQ(state(id), v1::GOAL_UNDERWAY);

  const std::string name = robot.intended->nodes()[0].name();
  EXPECT_EQ(request(name, v1::PROCESS_INTERRUPT), "");
  cycle();
  EXPECT_TRUE(robot.intended->behaviors().empty());
  EXPECT_EQ(request(std::to_string(robot.intended->nodes()[0].id()), v1::PROCESS_RESUME), "");
  cycle();
  EXPECT_FALSE(robot.intended->behaviors().empty());
  EXPECT_EQ(request(name, v1::PROCESS_RESUME), name + " was not interrupted");
  EXPECT_EQ(request("nothing", v1::PROCESS_INTERRUPT),
            "no process \"nothing\"; there are execute-intentions");
}

TEST_F(ShellTest, CancelsByDispose) {
  start();
  const v1::GoalId id = goals.ask(go_to(5.0, 0.0));
  cycle();
  goals.cancel(id);
  cycle();
  EXPECT_EQ(state(id), v1::GOAL_CANCELED);
  EXPECT_EQ(goals.status(id)->code(), v1::CODE_DISPOSED);
  EXPECT_TRUE(robot.intended->behaviors().empty());
}

TEST_F(ShellTest, EndsOrKeepsTheGoalsOfALostWriter) {
  start();
  v1::GoalId canceled;
  v1::GoalId kept;
  {
    bus::Node node(named("another"), bus);
    bus::GoalClient another(node, "another");
    canceled = another.ask(go_to(5.0, 0.0));
    v1::Goal goal = go_to(0.5, 0.0);
    goal.writer_lost(v1::WRITER_LOST_KEEP);
    kept = another.ask(goal);
    cycle();
    EXPECT_EQ(state(canceled), v1::GOAL_UNDERWAY);
  }
  cycle();
  EXPECT_EQ(state(canceled), v1::GOAL_CANCELED);
  EXPECT_EQ(goals.status(canceled)->code(), v1::CODE_WRITER_LOST);
  for (int i = 0; i < 100 && !bus::ended(state(kept)); ++i)
    cycle();
  EXPECT_EQ(state(kept), v1::GOAL_SUCCEEDED);
}

TEST_F(ShellTest, ARestartFindsTheGoalsThatAreThereAndRedoesNoneThatHasEnded) {
  const test::TempDir dir;
  start(dir.path("memory"));
  const v1::GoalId first = goals.ask(go_to(0.3, 0.0));
  for (int i = 0; i < 50 && (!goals.status(first) || !bus::ended(state(first))); ++i)
    cycle();
  ASSERT_EQ(state(first), v1::GOAL_SUCCEEDED);
  v1::Goal goal;
  goal.functor("go_to");
  goal.arguments().push_back(bus::point("position", 2.0, 0.0, 0.0, v1::FRAME_ROBOT));
  const double begun = robot.world.robot.pose_in_odom.x;
  const v1::GoalId second = goals.ask(goal);
  for (int i = 0; i < 20; ++i)
    cycle();
  ASSERT_EQ(state(second), v1::GOAL_UNDERWAY);
  kill();
  start(dir.path("memory"));
  cycle();
  EXPECT_EQ(state(first), v1::GOAL_SUCCEEDED);
  EXPECT_EQ(state(second), v1::GOAL_UNDERWAY);
  for (int i = 0; i < 200 && !bus::ended(state(second)); ++i)
    cycle();
  EXPECT_EQ(state(second), v1::GOAL_SUCCEEDED);
  EXPECT_NEAR(robot.world.robot.pose_in_odom.x, begun + 2.0, 0.2);
}

TEST_F(ShellTest, ARefusalReachesItsRequesterWithoutARobot) {
  start();
  v1::Goal goal;
  goal.functor("fly");
  const v1::GoalId refused = goals.ask(goal);
  const v1::GoalId waiting = goals.ask(go_to(1.0, 0.0));
  std::thread thread([&] { shell->run(stop); });
  EXPECT_TRUE(test::wait_until([&] {
    goals.poll();
    return goals.status(refused) && goals.status(waiting);
  }));
  stop.request();
  thread.join();
  EXPECT_EQ(state(refused), v1::GOAL_REFUSED);
  EXPECT_EQ(state(waiting), v1::GOAL_WAITING);
  EXPECT_EQ(goals.status(waiting)->code(), v1::CODE_NO_ROBOT);
}

}  // namespace
}  // namespace saphira::intentions
