// The demo over a serial line: simulated robot, line, bridge, behaviors and intentions, and the
// demo's goal in the demo's world; and the reaction time that such a line allows.
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench.hpp"
#include "node_options.hpp"
#include "process.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/cli/trace.hpp"
#include "saphira/command_line/command_line.hpp"
#include "serial_line.hpp"
#include "support/guarded.hpp"

using namespace saphira;
using std::chrono::milliseconds;

namespace {

// As in `saphira demo`.
constexpr double kGoalX = 16.0;
constexpr double kGoalY = 1.0;
constexpr double kDeadline = 180.0;  // [s] of robot time

struct Run {
  bool arrived = false;
  std::string outcome;
  cli::Track track;
  double time = 0.0;  // [s] of robot time
  std::uint64_t bad_packets = 0;
  double bytes_per_s[2] = {0.0, 0.0};  // to the robot, from it
  std::uint64_t waited[2] = {0, 0};    // the longest queue before the line [bytes]
};

Run demo(int baud, const std::string& seed) {
  const test::TempDir folder;
  const std::string domain = "197";
  const std::string name = "serial" + std::to_string(getpid());
  const std::vector<std::string> bus{"--robot", name, "--domain", domain};
  const auto with_bus = [&](std::vector<std::string> argv) {
    argv.insert(argv.end(), bus.begin(), bus.end());
    return argv;
  };
  const bench::Child simulator({"saphira-sim", "--world", config_folder() + "/worlds/office.wld",
                                "--robot", config_folder() + "/robots/pioneer.p", "--socket",
                                folder.path("robot"), "--trace", folder.path("trace.csv"), "--seed",
                                seed});
  const test::SerialLine line(folder.path("tty"), folder.path("robot"), baud);
  const bench::Child bridge(
      with_bus({"saphira-bridge", "--robots", config_folder() + "/robots", "--robot-port",
                "serial:" + folder.path("tty") + "@" + std::to_string(baud)}));
  const bench::Child behaviors(with_bus({"saphira-behaviors"}));
  const bench::Child intentions(with_bus({"saphira-intentions"}));

  bus::Node node(test::node_options("bench", name, domain));
  auto states = node.reader(bus::topics::kRobotState);
  bus::GoalClient goals(node, "bench");
  v1::Goal goal;
  goal.functor = "go_to";
  goal.arguments = {bus::point("position", kGoalX, kGoalY, 0.0, v1::FRAME_ODOM)};
  goal.deadline = kDeadline;
  const v1::GoalId id = goals.ask(goal);

  Run run;
  std::optional<v1::GoalStatus> status;
  const auto began = std::chrono::steady_clock::now();
  const auto patience = std::chrono::seconds(240);
  while (!(status && bus::ended(status->state)) &&
         std::chrono::steady_clock::now() - began < patience) {
    node.wait(milliseconds(100));
    goals.poll();
    status = goals.status(id);
    for (const auto& sample : states.take())
      run.bad_packets = sample.data.bad_packets;
  }
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  run.outcome = status ? bus::describe(*status) : "the goal got no answer";
  run.arrived = status && status->state == v1::GOAL_SUCCEEDED;
  run.time = status ? status->elapsed : 0.0;
  run.track = cli::evaluate_trace(
      read_file(folder.path("trace.csv")),
      status ? status->stamp.cycle : std::numeric_limits<std::uint64_t>::max(), "trace.csv");
  run.bytes_per_s[0] = static_cast<double>(line.to_robot()) / wall;
  run.bytes_per_s[1] = static_cast<double>(line.from_robot()) / wall;
  run.waited[0] = line.waited_to_robot();
  run.waited[1] = line.waited_from_robot();
  return run;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app{"The demo over a serial line, and the reaction time that the line allows"};
  bool json = false;
  int baud = 9600;
  std::string seed = "1";
  int count = 200;
  app.add_flag("--json", json, "one JSON object on the last line");
  app.add_option("--baud", baud, "of the line")
      .one_of({"9600", "19200", "38400", "57600", "115200"});
  app.add_option("--seed", seed, "of the simulator");
  app.add_option("--count", count, "reactions").in_range(10, 100000);
  if (const auto code = app.parse(argc, argv))
    return *code;
  return test::guarded([&] {
    const Run run = demo(baud, seed);
    const double line = baud / 10.0;
    std::printf("demo over %d baud: %s\n", baud, run.outcome.c_str());
    std::printf("  %.1f s of robot time, %.2f m, %ld contacts, clearance at least %.3f m\n",
                run.time, run.track.path, static_cast<long>(run.track.contacts),
                run.track.min_clearance);
    std::printf(
        "  to the robot %.0f bytes/s (%.0f %% of the line, %lu waited at most), from it %.0f "
        "(%.0f %%, %lu)\n",
        run.bytes_per_s[0], 100.0 * run.bytes_per_s[0] / line,
        static_cast<unsigned long>(run.waited[0]), run.bytes_per_s[1],
        100.0 * run.bytes_per_s[1] / line, static_cast<unsigned long>(run.waited[1]));
    std::printf("  bad packets %lu\n", static_cast<unsigned long>(run.bad_packets));
    const std::string text =
        bench::output_of({"saphira-bench-reaction", "--serial", std::to_string(baud), "--count",
                          std::to_string(count), "--json"});
    const std::size_t last = text.rfind("\n{");
    const auto reaction = nlohmann::json::parse(text.substr(last == std::string::npos ? 0 : last));
    std::fputs(text.substr(0, last == std::string::npos ? 0 : last + 1).c_str(), stdout);
    if (json)
      std::printf("%s\n", nlohmann::json{{"baud", baud},
                                         {"arrived", run.arrived},
                                         {"time_s", run.time},
                                         {"contacts", run.track.contacts},
                                         {"min_clearance_m", run.track.min_clearance},
                                         {"bytes_per_s_to_robot", run.bytes_per_s[0]},
                                         {"bytes_per_s_from_robot", run.bytes_per_s[1]},
                                         {"bad_packets", run.bad_packets},
                                         {"reaction_p50_us", reaction.at("p50_us")},
                                         {"reaction_p99_us", reaction.at("p99_us")},
                                         {"line_us", reaction.at("line_us")},
                                         {"reaction_unanswered", reaction.at("unanswered")}}
                              .dump()
                              .c_str());
    return run.arrived ? 0 : 1;
  });
}
