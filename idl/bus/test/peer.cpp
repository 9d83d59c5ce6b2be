// A program for tests that need another process or another machine: writes samples for the test, or
// reads samples and reports them.
//
//   saphira-bus-peer --role writer                a goal, and RobotState at --hz, until stopped
//   saphira-bus-peer --role reader --count N      ends when it has the goal and N states: exit 0;
//                                                 after --seconds without: exit 1
//   saphira-bus-peer --role watch --seconds S     reads for so long; says the longest silence
#include <chrono>
#include <cstdio>
#include <string>

#include "saphira/bus/program.hpp"
#include "saphira/command_line/command_line.hpp"

using namespace saphira;
using namespace saphira::bus;
using Clock = std::chrono::steady_clock;

namespace {

struct Wanted {
  std::string role = "reader";
  double hz = 20.0;
  int count = 20;
  double seconds = 20.0;
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

int write(Node& node, const Wanted& wanted, const Stop& stop) {
  auto goals = node.writer(topics::kGoals);
  auto robot = node.writer(topics::kRobotState);
  goals.write({.id = {node.instance(), 1}, .functor = "stop"});
  v1::RobotState state{.stamp = {.epoch = node.instance()}};
  auto next = Clock::now();
  while (!stop.requested()) {
    if (Clock::now() >= next) {
      ++state.stamp.cycle;
      robot.write(state);
      next += std::chrono::duration_cast<Clock::duration>(
          std::chrono::duration<double>(1.0 / wanted.hz));
    }
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(next - Clock::now());
    node.wait(std::max(left, std::chrono::milliseconds(0)), &stop);
    node.publish_status();
  }
  return kExitOk;
}

int read(Node& node, const Wanted& wanted, const Stop& stop) {
  auto goals = node.reader(topics::kGoals);
  auto robot = node.reader(topics::kRobotState);
  const auto start = Clock::now();
  auto last = start;
  double first = -1.0;
  double silence = 0.0;
  int count = 0;
  int goal_count = 0;
  int lost = 0;
  while (!stop.requested() && seconds_since(start) < wanted.seconds) {
    node.wait(std::chrono::milliseconds(50), &stop);
    goal_count += static_cast<int>(goals.take().size());
    lost += static_cast<int>(goals.take_lost().size());
    const int got = static_cast<int>(robot.take().size());
    if (got > 0) {
      if (count == 0)
        first = seconds_since(start);
      else
        silence = std::max(silence, seconds_since(last));
      last = Clock::now();
      count += got;
    }
    if (wanted.role == "reader" && count >= wanted.count && goal_count > 0)
      break;
  }
  const bool complete = count >= wanted.count && goal_count > 0;
  std::printf("states %d, first after %.3f s, longest silence %.3f s, goals %d, lost %d\n", count,
              first, silence, goal_count, lost);
  return complete ? kExitOk : kExitFailed;
}

}  // namespace

int main(int argc, char** argv) {
  Wanted wanted;
  return run_program(
      argc, argv, "peer", "The other side of a test of the bus",
      [&](CommandLine& app) {
        app.add_option("--role", wanted.role, "of this process")
            .one_of({"writer", "reader", "watch"});
        app.add_option("--hz", wanted.hz, "samples a second").positive();
        app.add_option("--count", wanted.count, "of samples");
        app.add_option("--seconds", wanted.seconds, "at most");
      },
      [&](const NodeOptions& options, const Stop& stop) {
        Node node(options);
        return wanted.role == "writer" ? write(node, wanted, stop) : read(node, wanted, stop);
      });
}
