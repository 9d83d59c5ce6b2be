// Plays a recording on the bus, as another robot. README.md.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>

#include "recorder.hpp"
#include "saphira/base/robot_name.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/introspect.hpp"
#include "saphira/bus/program.hpp"

namespace {

using namespace saphira;
using Clock = std::chrono::steady_clock;

constexpr auto kTurn = std::chrono::milliseconds(20);
// Longer turns are pauses: the program was stopped (Ctrl-Z).
constexpr double kLongestTurn = 0.5;
constexpr auto kPollPeriod = std::chrono::seconds(1);  // for a robot of that name, and for readers

struct Options {
  std::string file;
  std::string as;
  double rate = 1.0;
  std::vector<std::string> topics;
  double from = 0.0;
  bool list = false;
};

int list(const recorder::Contents& contents) {
  std::time_t began = contents.first_ns / 1'000'000'000;
  std::string date = std::ctime(&began);
  date.pop_back();
  std::printf("robot %s, %s, %.1f s\n", contents.robot.c_str(), date.c_str(), contents.seconds);
  for (const auto& [topic, count] : contents.samples)
    std::printf("%8llu  %s\n", static_cast<unsigned long long>(count), topic.c_str());
  return bus::kExitOk;
}

bool has_robot(bus::Node& node, const bus::Stop& stop) {
  const auto states = node.reader(bus::topics::kRobotState);
  const auto began = Clock::now();
  while (!stop.requested() && Clock::now() - began < kPollPeriod && states.matched() == 0)
    node.wait(kTurn, &stop);
  return states.matched() > 0;
}

/// A robot of the replay's name has come since, or its network.
bool has_come(bus::Node& node) {
  return std::ranges::any_of(bus::found_programs(node), [&](const bus::ProgramEntry& program) {
    return program.robot == node.options().robot && !program.silent &&
           (program.kind() == "bridge" || program.kind() == "intentions" ||
            program.kind() == "all");
  });
}

int replay(bus::NodeOptions node_options, const Options& options, const bus::Stop& stop) {
  std::ifstream file(options.file, std::ios::binary);
  if (!file) {
    std::fprintf(stderr, "saphira: %s\n", cannot_be(options.file, "read").c_str());
    return bus::kExitUsage;
  }
  const recorder::Contents contents = recorder::contents_of(file);
  if (contents.cut_off)
    std::fprintf(stderr,
                 "saphira: %s has no end, as after a kill of its recorder: read up to there\n",
                 options.file.c_str());
  if (contents.samples.empty())
    throw std::invalid_argument("it has no sample");
  if (options.list)
    return list(contents);
  for (const std::string& topic : options.topics)
    if (!contents.samples.contains(topic))
      throw std::invalid_argument("it has no sample of \"" + topic + "\"; --list shows its topics");
  node_options.robot = options.as.empty() ? contents.robot + "-replay" : options.as;
  bus::Node node(node_options);
  node.status().state = v1::SERVICE_RUNNING;
  if (has_robot(node, stop)) {
    std::fprintf(stderr, "saphira: a robot %s is on the bus; --as NAME gives another name\n",
                 node_options.robot.c_str());
    return bus::kExitFailed;
  }
  file.clear();
  file.seekg(0);
  recorder::Reader reader(file);
  recorder::Player player(node, reader, contents,
                          {{options.topics.begin(), options.topics.end()}, options.from});
  std::fprintf(stderr,
               "plays %.0f s as robot %s: saphira --robot %s status; Ctrl-Z pauses it, Ctrl-C ends "
               "it\n",
               std::max(0.0, contents.seconds - options.from), node_options.robot.c_str(),
               node_options.robot.c_str());
  for (const auto look = Clock::now(); !stop.requested() && Clock::now() - look < kPollPeriod;)
    node.wait(kTurn, &stop);
  auto before = Clock::now();
  bool goes_on = true;
  while (!stop.requested() && goes_on) {
    node.publish_status();
    if (has_come(node)) {
      std::fprintf(stderr, "saphira: a robot %s has come on the bus: the replay ends here\n",
                   node_options.robot.c_str());
      return bus::kExitFailed;
    }
    const auto now = Clock::now();
    const double turn = std::chrono::duration<double>(now - before).count();
    before = now;
    goes_on = player.poll((turn > kLongestTurn ? 0.0 : turn) * options.rate);
    for (const recorder::Player::Gap& gap : player.take_gaps())
      std::fprintf(stderr,
                   "saphira: after %.1f s the clock of the recorder steps by %.0f s; the step is "
                   "left out\n",
                   gap.at, gap.step);
    node.wait(kTurn, &stop);
  }
  std::fprintf(stderr, "%llu samples\n", static_cast<unsigned long long>(player.written()));
  return bus::kExitOk;
}

}  // namespace

int main(int argc, char** argv) {
  Options own;
  return bus::run_program(
      argc, argv, "replay", "Plays a recording on the bus, as another robot. Commands are left out",
      [&](CommandLine& app) {
        app.add_option("file", own.file, "FILE.mcap of saphira record").required();
        app.add_option("--as", own.as, "the robot's name on the bus; else ROBOT-replay")
            .check(trouble_of_robot);
        app.add_option("--rate", own.rate, "seconds of the recording in a second")
            .positive()
            .in_range(0.0, 1000.0);
        app.add_option("--topic", own.topics, "this one alone; may be repeated").one_value_each();
        app.add_option("--from", own.from, "[s] into the recording; begin there")
            .in_range(0.0, 1e9);
        app.add_flag("--list", own.list, "list its contents, and end");
      },
      [&](const bus::NodeOptions& options, const bus::Stop& stop) {
        try {
          return replay(options, own, stop);
        } catch (const std::invalid_argument& error) {
          std::fprintf(stderr, "saphira: %s: %s\n", own.file.c_str(), error.what());
          return static_cast<int>(bus::kExitUsage);
        }
      });
}
