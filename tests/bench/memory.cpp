// The lasting memory cost of a misused intentions service: resident memory before, after many
// goals that it refuses, after as many again, and after activities that begin others without end.
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench.hpp"
#include "node_options.hpp"
#include "process.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/command_line/command_line.hpp"
#include "support/guarded.hpp"

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using namespace saphira;
using saphira::bench::Child;

struct Options {
  unsigned domain = 199;
  unsigned goals = 10000;
  // [s] The status of an ended goal stays for a minute; then memory is returned, every 30 s.
  unsigned pause = 100;
  bool json = false;
};

constexpr unsigned kBatch = 100;
constexpr auto kPatience = 60s;
constexpr auto kRunawayTime = 20s;

// Activities that begin others, down to :two, which waits, up to the service's limit.
constexpr const char* kRunaway =
    "(defintention :runaway :goals '((INTEND :half () :blocking nil) (INTEND :half ())))\n"
    "(defintention :half :goals '((SPLIT (INTEND :many ()) (INTEND :many ()))"
    " (WAIT-FOR stalled :forever t)))\n"
    "(defintention :many :goals '((:again (INTEND :one () :blocking nil)) (GOTO :again)))\n"
    "(defintention :one :goals '((SPLIT (INTEND :two ()) (INTEND :two ()))"
    " (WAIT-FOR stalled :forever t)))\n"
    "(defintention :two :goals '((WAIT-FOR stalled :forever t)))\n";

class Misuse {
 public:
  Misuse(const Options& options, pid_t intentions) : options_(options), intentions_(intentions) {}

  /// Sends goals that are all refused; they have ended when it returns.
  void refused() {
    bus::GoalClient goals(node_, "bench memory", 60s);
    for (unsigned asked = 0; asked < options_.goals; asked += kBatch) {
      std::vector<v1::GoalId> batch;
      for (unsigned i = 0; i < kBatch; ++i)
        batch.push_back(goals.ask(goal("fly")));
      wait(goals, batch);
      for (const v1::GoalId& id : batch)
        goals.cancel(id);  // the writer of so many instances takes minutes to end
    }
  }
  /// An activity that has time to begin the allowed number, and is canceled; returns the peak of
  /// memory meanwhile [MB].
  double runaway() {
    bus::GoalClient goals(node_, "bench memory");
    const v1::GoalId id = goals.ask(goal("runaway"));
    double most = 0.0;
    for (const auto end = Clock::now() + kRunawayTime; Clock::now() < end;) {
      node_.wait(20ms);
      goals.poll();
      most = std::max(most, bench::resident_mb(intentions_));
    }
    goals.cancel(id);
    wait(goals, {id});
    std::printf("  %s\n", bus::describe(*goals.status(id)).c_str());
    return most;
  }
  /// [MB] after ended goals are forgotten.
  double later() const {
    std::this_thread::sleep_for(std::chrono::seconds(options_.pause));
    return bench::resident_mb(intentions_);
  }

 private:
  static v1::Goal goal(const std::string& functor) {
    v1::Goal goal;
    goal.functor = functor;
    return goal;
  }

  void wait(bus::GoalClient& goals, const std::vector<v1::GoalId>& ids) {
    const auto end = Clock::now() + kPatience;
    const auto over = [&](const v1::GoalId& id) {
      const auto status = goals.status(id);
      return status && bus::ended(status->state);
    };
    while (!std::all_of(ids.begin(), ids.end(), over)) {
      if (Clock::now() > end)
        throw std::runtime_error("a goal did not end within a minute");
      node_.wait(20ms);
      goals.poll();
    }
  }

  const Options options_;
  const pid_t intentions_;
  bus::Node node_{test::node_options("bench", "bench-memory")};
};

pid_t find(pid_t parent, const std::string& name) {
  for (const pid_t pid : bench::family(parent))
    if (bench::name_of(pid) == name)
      return pid;
  throw std::runtime_error("the deployment did not come up");
}

int run(const Options& options) {
  const test::TempDir folder;
  std::filesystem::create_directory(folder.path("activities"));
  std::ofstream(folder.path("activities/runaway.act")) << kRunaway;
  setenv("SAPHIRA_DOMAIN", std::to_string(options.domain).c_str(), 1);
  setenv("SAPHIRA_ROBOT", "bench-memory", 1);
  const Child up({"saphira", "up", "demo", "--set", "activities=" + folder.path("activities")});
  std::this_thread::sleep_for(5s);  // past discovery and the connection to the robot

  const pid_t intentions = find(up.pid(), "saphira-intentions");
  Misuse misuse(options, intentions);
  std::vector<std::pair<std::string, double>> measured;
  const auto note = [&](const std::string& what, double mb) {
    std::printf("%-32s %6.1f MB\n", what.c_str(), mb);
    std::fflush(stdout);
    measured.emplace_back(what, mb);
  };
  note("before", bench::resident_mb(intentions));
  for (const char* name : {"refused", "refused_again"}) {
    misuse.refused();
    note(name, bench::resident_mb(intentions));
    note(std::string(name) + "_later", misuse.later());
  }
  for (const char* name : {"runaway", "runaway_again"}) {
    note(name, misuse.runaway());
    note(std::string(name) + "_later", misuse.later());
  }
  if (options.json) {
    nlohmann::json all;
    for (const auto& [what, mb] : measured)
      all[what + "_mb"] = mb;
    std::printf("%s\n", all.dump().c_str());
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app{"Memory of a misused intentions service"};
  Options options;
  app.add_flag("--json", options.json, "one JSON object on the last line");
  app.add_option("--domain", options.domain, "DDS domain; nobody else's").in_range(0, 232);
  app.add_option("--goals", options.goals, "that are refused").in_range(100, 1000000);
  app.add_option("--pause", options.pause, "[s] until what has ended is forgotten")
      .in_range(0, 3600);
  if (const auto code = app.parse(argc, argv))
    return *code;
  return test::guarded([&] { return run(options); }, 3);
}
