#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "door.hpp"
#include "node_options.hpp"
#include "only.hpp"
#include "saphira/bus/agent.hpp"

namespace saphira::mcp {

/// A client's door on a bus in memory. The test is the facilitator and its agent.
class DoorInMemory : public testing::Test {
 protected:
  DoorInMemory() {
    agents.write({.id = 7,
                  .name = "sweeper",
                  .capabilities = {bus::action("sweep", "sweeps a room",
                                               {bus::text_slot("room", "of the map", true),
                                                bus::number_slot("dust", "[g] that was found")}),
                                   bus::capability("place_of", "where a person is",
                                                   {bus::text_slot("person", "a name", true),
                                                    bus::text_slot("place", "of the map")})}});
    schemas.write(v1::ActivitySchemas());
    turn();
    turn(3.0);  // nothing more is awaited
  }
  void turn(double seconds = 0.0) {
    now += seconds;
    robot.poll(now);
    door->turn(now);
  }
  void call(int id, const std::string& tool, const Json& arguments) {
    session.take(Json{{"jsonrpc", "2.0"},
                      {"id", id},
                      {"method", "tools/call"},
                      {"params", {{"name", tool}, {"arguments", arguments}}}}
                     .dump());
    turn();
  }
  /// The result of a request of a client that knows tasks.
  Json ask(int id, const std::string& method, Json parameters) {
    parameters["_meta"] = {{"io.modelcontextprotocol/protocolVersion", Session::kModern},
                           {"io.modelcontextprotocol/clientCapabilities",
                            {{"extensions", {{"io.modelcontextprotocol/tasks", Json::object()}}}}}};
    session.take(
        Json{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", parameters}}.dump());
    turn();
    return result(id);
  }
  /// The robot's speed [m/s] from now on.
  void drive(double velocity) {
    robots.write({.stamp = {1, ++cycle}, .velocity = velocity});
    turn();
  }
  void believe(const std::string& name, const std::string& value) {
    v1::Belief belief{.name = name, .value = value};
    beliefs.write({.beliefs = {belief}});
    turn();
  }
  void report(const std::string& functor, const std::vector<v1::Argument>& arguments) {
    events.write({.source = "karen", .functor = functor, .arguments = arguments});
    turn();
  }
  /// The result of a call; null: it has none yet.
  Json result(int id) {
    for (const Line& line : session.take_lines()) {
      const Json message = Json::parse(line.text);
      if (message.contains("result"))
        results[message["id"].get<int>()] = message["result"];
    }
    const auto found = results.find(id);
    return found == results.end() ? Json() : found->second;
  }
  /// The result of a call that is answered at once.
  Json answer(const std::string& tool, const Json& arguments = Json::object()) {
    call(--answered, tool, arguments);
    return result(answered);
  }
  /// Asks for an action that is not done at once; its handle.
  std::string begin_sweep() {
    call(1, "sweep", {{"room", "kitchen"}, {"wait_s", 0}});
    return result(1)["structuredContent"]["goal"];
  }
  /// The robot's answer to the newest words of the client.
  void reply(const std::string& text, bool end) {
    for (const auto& sample : words.take())
      spoken = sample.data;
    replies.write({.answers = spoken.id, .text = text, .end = end});
    turn();
  }
  /// The status by intentions of a goal that "rover" asked for in this program.
  v1::GoalStatus tell_goal(v1::GoalState state) {
    v1::GoalStatus status{
        .id = {node.instance(), 77}, .requester = "rover 2", .functor = "patrol", .state = state};
    statuses.write(status);
    turn();
    return status;
  }
  v1::Request heard() {
    const auto samples = solve.take();
    EXPECT_EQ(samples.size(), 1U);
    return samples.empty() ? v1::Request() : samples.front().data;
  }
  void say(const v1::Request& request, v1::AnswerCode code, const std::string& text,
           const std::vector<v1::Argument>& found = {}) {
    solved.write({.asker = request.asker,
                  .number = request.number,
                  .service = "sweeper",
                  .code = code,
                  .text = text,
                  .results = found});
    turn();
  }
  Json form(const std::string& tool) const {
    for (const Tool& each : robot.tools())
      if (each.name == tool)
        return each.output;
    return nullptr;
  }

  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  bus::Node other{test::memory_options("facilitator"), memory};
  bus::Node node{test::memory_options("mcp"), memory};
  bus::Writer<v1::Agent> agents = other.writer(bus::topics::kAgents);
  bus::Writer<v1::ActivitySchemas> schemas = other.writer(bus::topics::kActivitySchemas);
  bus::Reader<v1::Request> solve = other.reader<v1::Request>(bus::topics::kSolve);
  bus::Writer<v1::Answer> solved = other.writer(bus::topics::kSolved);
  bus::Writer<v1::RobotState> robots = other.writer(bus::topics::kRobotState);
  bus::Writer<v1::BeliefSet> beliefs = other.writer(bus::topics::kBeliefs);
  bus::Writer<v1::Knowledge> knowledge = other.writer(bus::topics::kKnows);
  bus::Writer<v1::AgentEvent> events = other.writer(bus::topics::kAgentEvents);
  bus::Reader<v1::Utterance> words = other.reader(bus::topics::kHeard);
  bus::Writer<v1::Utterance> replies = other.writer(bus::topics::kSaid);
  bus::Writer<v1::GoalStatus> statuses = other.writer(bus::topics::kGoalStatus);
  bus::Reader<v1::Goal> goals = other.reader(bus::topics::kGoals);
  bus::Reader<v1::MotorCommand> presses = other.reader<v1::MotorCommand>(bus::topics::kDriveEstop);
  v1::Utterance spoken;  ///< the newest words of the client
  std::uint64_t cycle = 0;
  Session session{"saphira", "1", "a robot"};
  Robot robot{node};
  std::unique_ptr<Door> door = std::make_unique<Door>(node, robot, session, "model");
  std::map<int, Json> results;
  int answered = 0;  ///< the id of the newest such call
  double now = 100.0;
};

}  // namespace saphira::mcp
