#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <thread>
#include <tuple>

#include "intentions/shell/convert.hpp"
#include "intentions/shell/service.hpp"
#include "node_options.hpp"
#include "process.hpp"
#include "requests/shell/convert.hpp"
#include "saphira/bus/agent.hpp"
#include "saphira/bus/goal_client.hpp"
#include "scripted_bus.hpp"

namespace saphira::intentions {
namespace {

/// The service, a scripted robot and a requester on a bus within the process, in one thread.
class ShellTest : public testing::Test {
 protected:
  void start(const std::string& memory_file = {}) {
    service.emplace(test::memory_options("intentions", true), bus);
    Options options;
    options.memory_file = memory_file;
    options.registration = false;
    options.interpretation = false;
    options.folder = folder;
    shell.emplace(*service, [options](runtime::Ports& ports) {
      return std::make_unique<Service>(ports, options);
    });
  }
  void kill() {
    shell.reset();
    service.reset();
  }
  void cycle() {
    robot.publish_state();
    // After a restart it first steps the cycles on the bus.
    bool acted = false;
    for (int i = 0; i < 8 && !acted; ++i) {
      ASSERT_TRUE(shell->step(stop));
      acted = robot.act();
    }
    ASSERT_TRUE(acted);
    goals.poll();
  }
  v1::GoalState state(const v1::GoalId& id) { return goals.status(id)->state; }

  std::shared_ptr<bus::MemoryBus> bus = bus::make_memory_bus();
  bus::Stop stop;
  bus::Node robot_node{test::memory_options("robot", true), bus};
  bus::Node requester{test::memory_options("requester", true), bus};
  ScriptedBus robot{robot_node};
  bus::GoalClient goals{requester, "a test"};
  std::optional<bus::Node> service;
  std::optional<runtime::Shell> shell;
  std::string folder;  ///< of activities
};

TEST(Goals, AWithdrawalWithoutASampleHasNoReasonOfAnother) {
  bus::Sample<v1::Goal> sample{{.withdrawn = "carl was sure"}, {}};
  EXPECT_EQ(from_bus(sample).event.why, "carl was sure");
  sample.info.disposed = true;
  EXPECT_EQ(from_bus(sample).event.why, "");
  EXPECT_EQ(from_bus(sample).event.kind, GoalEvent::Kind::kDisposed);
}

TEST_F(ShellTest, DrivesToAGoalAndSaysSo) {
  start();
  const v1::GoalId id = goals.ask(go_to(1.0, 0.5));
  for (int i = 0; i < 100 && (!goals.status(id) || !bus::ended(state(id))); ++i)
    cycle();
  EXPECT_EQ(state(id), v1::GOAL_SUCCEEDED) << bus::describe(*goals.status(id));
  EXPECT_EQ(goals.status(id)->requester, "a test");
  EXPECT_EQ(goals.status(id)->stamp.epoch, robot.epoch);
  EXPECT_EQ(goals.status(id)->stamp.cycle, robot.cycle);
  EXPECT_LE((robot.world.robot.pose_in_odom.position() - Vec2(1.0, 0.5)).norm(), 0.15);
  EXPECT_TRUE(robot.intended->behaviors.empty());
  EXPECT_TRUE(robot.intended->behavior_control);
}

TEST_F(ShellTest, AProgramThatWasSilentIsBelievedAgainAndItsGoalsGoOn) {
  start();
  auto beliefs = requester.reader(bus::topics::kBeliefs);
  std::optional<v1::BeliefSet> newest;
  const auto believed = [&] {
    cycle();
    cycle();
    if (auto updates = beliefs.take_newest())
      newest = std::move(updates);
    return newest && std::any_of(newest->beliefs.begin(), newest->beliefs.end(),
                                 [](const v1::Belief& one) { return one.name == "door"; });
  };
  bus::Node node(test::memory_options("another", true), bus);
  bus::GoalClient another(node, "another");
  auto claims = node.writer(bus::topics::kBeliefClaims);
  claims.write({.id = {.number = 1},
                .name = "door",
                .value = "open",
                .writer_lost = v1::WRITER_LOST_CANCEL});
  const v1::GoalId id = another.ask(go_to(5.0, 0.0));
  EXPECT_TRUE(believed());
  EXPECT_EQ(state(id), v1::GOAL_UNDERWAY);
  bus::set_silent(*bus, "another", true);
  EXPECT_FALSE(believed());
  EXPECT_EQ(goals.status(id)->code, v1::CODE_WRITER_LOST);
  EXPECT_TRUE(robot.intended->behaviors.empty());
  bus::set_silent(*bus, "another", false);
  EXPECT_TRUE(believed());
  EXPECT_EQ(state(id), v1::GOAL_UNDERWAY);
  // A value that cannot be read changes nothing.
  claims.write({.id = {.number = 1}, .name = "door", .value = "(a"});
  EXPECT_TRUE(believed());
}

TEST_F(ShellTest, IsDegradedWhileItsMemoryCannotBeWrittenAndSavesItLater) {
  const test::TempDir dir;
  start(dir.path("memory"));
  cycle();
  const std::string in_the_way = dir.path("memory.work");
  std::filesystem::remove(in_the_way);
  std::filesystem::create_directories(in_the_way + "/folder");
  const v1::GoalId id = goals.ask(go_to(9.0, 0.0));
  for (int i = 0; i < 3; ++i)
    cycle();
  EXPECT_EQ(service->status().state, v1::SERVICE_DEGRADED);
  EXPECT_TRUE(service->status().reason.starts_with("the memory file: cannot be written"))
      << service->status().reason;
  std::filesystem::remove_all(in_the_way);
  for (int i = 0; i < 12; ++i)
    cycle();
  EXPECT_EQ(service->status().state, v1::SERVICE_RUNNING) << service->status().reason;
  EXPECT_TRUE(std::filesystem::is_regular_file(in_the_way));
  EXPECT_EQ(state(id), v1::GOAL_UNDERWAY);
}

TEST_F(ShellTest, ARestartFindsTheGoalsThatAreThereAndRedoesNoneThatHasEnded) {
  const test::TempDir dir;
  start(dir.path("memory"));
  const v1::GoalId first = goals.ask(go_to(0.3, 0.0));
  for (int i = 0; i < 50 && (!goals.status(first) || !bus::ended(state(first))); ++i)
    cycle();
  ASSERT_EQ(state(first), v1::GOAL_SUCCEEDED);
  const double begun = robot.world.robot.pose_in_odom.x;
  const v1::GoalId second =
      goals.ask(test::goal("go_to", {bus::point("position", 2.0, 0.0, 0.0, v1::FRAME_ROBOT)}));
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
  const v1::GoalId refused = goals.ask(test::goal("fly"));
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
  EXPECT_EQ(goals.status(waiting)->code, v1::CODE_NO_ROBOT);
}

TEST_F(ShellTest, AnActivityFromAFileIsAGoalAndIsTakenAnewWhenItIsWritten) {
  const test::TempDir files;
  folder = files.path();
  const auto write = [&](const std::string& text, int time) {
    const std::string path = files.path("mine.act");
    std::ofstream(path) << text;
    std::filesystem::last_write_time(path,
                                     std::filesystem::file_time_type(std::chrono::seconds(time)));
  };
  write("(defintention :greet :params ((who :text)) :goals '((EXECUTE (say \"hello ~a\" who))))",
        1);
  auto messages = requester.reader(bus::topics::kMessages);
  auto schemas = requester.reader(bus::topics::kActivitySchemas);
  start();
  const v1::Goal goal = test::goal("greet", {bus::text("who", "Karen")});
  v1::GoalId id = goals.ask(goal);
  for (int i = 0; i < 20; ++i)
    cycle();
  EXPECT_EQ(state(id), v1::GOAL_SUCCEEDED);
  auto said = messages.take_newest();
  ASSERT_TRUE(said);
  EXPECT_EQ(said->text, "hello Karen");
  const auto known = schemas.take_newest();
  ASSERT_TRUE(known);
  EXPECT_EQ(known->trouble, "");
  EXPECT_TRUE(std::any_of(known->schemas.begin(), known->schemas.end(),
                          [](const v1::ActivitySchema& one) { return one.name == "greet"; }));
}

TEST_F(ShellTest, AnActivityAsksAgents) {
  const test::TempDir files;
  folder = files.path();
  std::ofstream(files.path("mine.act"))
      << "(defintention :where :params ((who :text))"
         " :goals '((ASK q place_of ((person . who) (place . nil)) :timeout 60)"
         " (SUCCEED \"in ~a\" (answer q 'place))))";
  start();
  const v1::Goal where = test::goal("where", {bus::text("who", "karen")});
  auto asked = requester.reader<v1::Request>(bus::topics::kSolve);
  auto answers = requester.writer(bus::topics::kSolved);
  const v1::GoalId id = goals.ask(where);
  for (int i = 0; i < 20; ++i) {
    cycle();
    for (const auto& sample : asked.take()) {
      EXPECT_EQ(sample.data.functor, "place_of");
      EXPECT_EQ(bus::text_of(sample.data.arguments, "person"), "karen");
      v1::Answer answer{
          .asker = sample.data.asker, .number = sample.data.number, .code = v1::ANSWER_UNDERWAY};
      answers.write(answer);
      answer.code = v1::ANSWER_DONE;
      answer.results.push_back(bus::text("place", "EJ-231"));
      answers.write(answer);
    }
  }
  EXPECT_EQ(state(id), v1::GOAL_SUCCEEDED);
  EXPECT_EQ(goals.status(id)->reason, "in EJ-231");
}

// At the same cycle in every run, whenever the behaviors service's sample arrives.
TEST_F(ShellTest, InLockstepItKnowsWhatBehaviorsThereAre) {
  const test::TempDir files;
  folder = files.path();
  std::ofstream(files.path("mine.act")) << "(defintention :mine :goals '((INTEND :Nonsense ())))";
  start();
  robot.have({"Follow"});
  const v1::GoalId id = goals.ask(test::goal("mine"));
  for (int i = 0; i < 20; ++i)
    cycle();
  EXPECT_EQ(state(id), v1::GOAL_FAILED);
  EXPECT_NE(goals.status(id)->reason.find("neither an activity nor a behavior"), std::string::npos)
      << goals.status(id)->reason;
}

Arguments all_kinds() {
  return {number("speed", 0.25), text("name", "über \"x\""), point("position", {1.0, -2.0, 0.5}),
          point("other", {1e-17, 1e9, -3.0}, Frame::robot),
          point("third", {0.1, 0.2, 0.3}, Frame::map)};
}

TEST(Convert, AGoalIsTakenWhole) {
  v1::Goal theirs{.id = {0xffffffffffffffffULL, 3},
                  .requester = "somebody",
                  .functor = "go_to",
                  .arguments = saphira::to_bus(all_kinds()),
                  .priority = -7,
                  .deadline = 12.5,
                  .writer_lost = v1::WRITER_LOST_KEEP,
                  .level = 0.25};
  EXPECT_EQ(from_bus(theirs), (Goal{{0xffffffffffffffffULL, 3},
                                    "somebody",
                                    "go_to",
                                    all_kinds(),
                                    -7,
                                    12.5,
                                    v1::WRITER_LOST_KEEP,
                                    0.25}));
}

TEST(Convert, WhatDoesNotKeepToTheContractIsRefusedLater) {
  v1::Argument argument{.kind = static_cast<v1::ArgumentKind>(77),
                        .frame = static_cast<v1::Frame>(77)};
  EXPECT_EQ(saphira::from_bus(argument).kind, ArgumentKind::unbound);
}

TEST(Convert, AGrantSaysWhyTheBehaviorsDoNotDriveAndWhichPersonDoes) {
  v1::Grant grant;
  grant.refused.resize(2);
  grant.refused[0].role = v1::ROLE_DIRECT;
  grant.refused[0].reason = "of another";
  grant.refused[1].role = v1::ROLE_BEHAVIORS;
  grant.refused[1].reason = "a person drives";
  grant.role = v1::ROLE_TELEOP;
  grant.waits_for_hand_back = true;
  Core::Received::Grant received = from_bus(grant);
  EXPECT_FALSE(received.pressed);
  EXPECT_EQ(received.refusal, "a person drives");
  EXPECT_EQ(received.person, "a person");
  EXPECT_TRUE(received.waits_for_hand_back);
  grant.source = "Ann";
  EXPECT_EQ(from_bus(grant).person, "Ann");
  grant.role = v1::ROLE_BEHAVIORS;
  grant.estopped = true;
  grant.estop_source = "a button";
  received = from_bus(grant);
  EXPECT_TRUE(received.pressed);
  EXPECT_EQ(received.source, "a button");
  EXPECT_EQ(received.refusal, "");
  EXPECT_EQ(received.person, "");
}

TEST(Convert, WhichMotorsHavePowerAndWhichRobotIsConnected) {
  for (const auto& [status, connected, power] :
       {std::tuple(v1::MOTORS_MOVING, true, true), std::tuple(v1::MOTORS_NO_POWER, true, false),
        std::tuple(v1::MOTORS_NOT_CONNECTED, false, true)}) {
    const Robot robot = from_bus(v1::RobotState{.status = status});
    EXPECT_EQ(robot.connected, connected) << status;
    EXPECT_EQ(robot.has_power, power) << status;
  }
}

TEST(Convert, ThePlaceOnTheMapOnlyWhereRegistrationKnowsIt) {
  v1::Registration registration{.stamp = {.cycle = 100},
                                .state = v1::REGISTRATION_TRACKING,
                                .odom = 4,
                                .odom_in_map = {.x = 2.0, .th = 0.5}};
  EXPECT_EQ(odom_in_map_from_bus(registration, 101, 4), (Pose{2.0, 0.0, 0.5}));
  EXPECT_TRUE(odom_in_map_from_bus(registration, 100 + kRegistrationLease, 4));
  EXPECT_FALSE(odom_in_map_from_bus(registration, 101 + kRegistrationLease, 4));
  EXPECT_FALSE(odom_in_map_from_bus(registration, 101, 5));
  registration.state = v1::REGISTRATION_LOST;
  EXPECT_FALSE(odom_in_map_from_bus(registration, 101, 4));
  registration.state = v1::REGISTRATION_UNPLACED;
  EXPECT_FALSE(odom_in_map_from_bus(registration, 101, 4));
  registration.state = v1::REGISTRATION_OFF;
  EXPECT_TRUE(odom_in_map_from_bus(registration, 101, 4));
}

TEST(Convert, WhatInterpretationSawCountsForAWhile) {
  v1::Perception perception{.stamp = {.cycle = 100}, .odom = 4};
  perception.percepts.emplace_back();
  EXPECT_EQ(percepts_from_bus(perception, 100 + kRegistrationLease, 4).value().size(), 1U);
  EXPECT_FALSE(percepts_from_bus(perception, 101 + kRegistrationLease, 4));
  EXPECT_TRUE(percepts_from_bus(perception, 101, 5).value().empty()) << "of another odom frame";
}

}  // namespace
}  // namespace saphira::intentions
