// The cost of Python: a goal from its question to its end, and messages received, by the package
// saphira and by C++ in the same run. This program is the robot, which answers at once. Messages
// count by the processor's time: the rate that comes through is the writer's and the network's.
#include <stdlib.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <future>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/command_line/command_line.hpp"
#include "support/guarded.hpp"
#include "support/node_options.hpp"
#include "support/quantile.hpp"

namespace {

using namespace saphira;
using nlohmann::json;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr int kGoals = 500;
constexpr double kListening = 5.0;  // [s]

constexpr const char* kPython = R"(
import json, sys, time
import saphira
from saphira import topics

goals, listening = int(sys.argv[1]), float(sys.argv[2])
with saphira.connect("asker") as robot:
    robot.do("stand").wait()
    us = []
    for _ in range(goals):
        begun = time.perf_counter()
        robot.do("stand").wait()
        us.append(1e6 * (time.perf_counter() - begun))
    states = robot.watch(topics.ROBOT_STATE)
    next(states)
    begun, worked, count = time.perf_counter(), time.process_time(), 0
    while time.perf_counter() < begun + listening:
        next(states)
        count += 1
    print(json.dumps({"us": us, "state_us": 1e6 * (time.process_time() - worked) / count}))
)";

bus::NodeOptions options(const std::string& name) {
  return test::node_options(name, std::getenv("SAPHIRA_ROBOT"));
}

/// The same in C++.
int ask() {
  bus::Node node(options("asker"));
  bus::GoalClient goals(node, "asker");
  const auto whole = [&] {
    const auto begun = Clock::now();
    const v1::GoalId id = goals.ask({.functor = "stand"});
    while (!goals.status(id) || !bus::ended(goals.status(id)->state)) {
      node.wait(std::chrono::milliseconds(200));
      goals.poll();
    }
    return 1e6 * Seconds(Clock::now() - begun).count();
  };
  whole();
  std::vector<double> us;
  for (int i = 0; i < kGoals; ++i)
    us.push_back(whole());
  auto states = node.reader(bus::topics::kRobotState);
  std::size_t count = 0;
  while (states.take().empty())
    node.wait(std::chrono::milliseconds(200));
  const double worked = bench::cpu_seconds(getpid());
  for (const auto begun = Clock::now(); Seconds(Clock::now() - begun).count() < kListening;) {
    node.wait(std::chrono::milliseconds(200));
    count += states.take().size();
  }
  const double state_us =
      1e6 * (bench::cpu_seconds(getpid()) - worked) / static_cast<double>(count);
  std::puts(json{{"us", us}, {"state_us", state_us}}.dump().c_str());
  return 0;
}

/// Runs a program, and is its robot meanwhile: each goal succeeds at once, and while somebody
/// listens there are about a thousand states a second.
json serve(bus::Node& node, const std::vector<std::string>& program) {
  auto goals = node.reader(bus::topics::kGoals);
  auto statuses = node.writer(bus::topics::kGoalStatus);
  auto states = node.writer(bus::topics::kRobotState);
  v1::RobotState state{.stamp = {1, 0}};
  auto output = std::async(std::launch::async, [&] { return bench::output_of(program); });
  while (output.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    node.wait(std::chrono::milliseconds(1));
    if (states.matched() > 0) {
      ++state.stamp.cycle;
      states.write(state);
    }
    for (const auto& sample : goals.take())
      if (!sample.info.disposed)
        statuses.write({.id = sample.data.id,
                        .requester = sample.data.requester,
                        .functor = sample.data.functor,
                        .state = v1::GOAL_SUCCEEDED});
  }
  const json told = json::parse(output.get());
  std::vector<double> us = told["us"];
  return {{"goal_us_p50", test::quantile(us, 0.5)},
          {"goal_us_p99", test::quantile(us, 0.99)},
          {"state_cpu_us", told["state_us"]}};
}

int measure(bool as_json) {
  setenv("SAPHIRA_DOMAIN", "198", 1);
  setenv("SAPHIRA_ROBOT", "bench-python", 1);
  const auto self = std::filesystem::read_symlink("/proc/self/exe");
  setenv("PYTHONPATH", (self.parent_path().parent_path() / "python").c_str(), 1);
  bus::Node node(options("robot"));
  const json cpp = serve(node, {self.string(), "--ask"});
  const json python = serve(node, {"/usr/bin/python3", "-c", kPython, std::to_string(kGoals),
                                   std::to_string(kListening)});
  const auto ratio = [&](const char* of) {
    return python[of].get<double>() / cpp[of].get<double>();
  };
  bench::print({{"python", python},
                {"cpp", cpp},
                {"goal_ratio", ratio("goal_us_p50")},
                {"state_ratio", ratio("state_cpu_us")}},
               as_json);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app{"The cost of Python: a goal's round trip, and messages received, beside C++"};
  bool as_json = false;
  bool asks = false;
  app.add_flag("--json", as_json, "one JSON object");
  app.add_flag("--ask", asks, "be the one that asks in C++").hidden();
  if (const auto code = app.parse(argc, argv))
    return *code;
  return test::guarded([&] { return asks ? ask() : measure(as_json); });
}
