#include "stop_ways.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "../acceptance/system.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/cycle.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/teleop/pilot.hpp"

namespace saphira::bench {

namespace {

using std::chrono::milliseconds;
using test::Process;
using test::wait_until;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

constexpr milliseconds kPatience{15000};
constexpr std::uint64_t kWatched = 30;  // [cycles] after the stop
constexpr double kMoved = 0.02;         // [m], [rad]
constexpr double kSpeed = 0.2;          // [m/s] of a person

/// A robot with all programs that may move it or stop it.
class Site {
 public:
  Site() {
    system_.start_all();
    for (const char* name : {"saphira-facilitator", "saphira-dialogue"})
      system_.start(name);
    const std::string in = system_.folder().path("mcp.in");
    if (mkfifo(in.c_str(), 0600) != 0)
      throw std::runtime_error("no pipe for MCP");
    mcp_ = std::make_unique<Process>(
        Words{"/bin/sh", "-c", "exec " + test::program("saphira-mcp") + " < " + in},
        system_.folder().path("mcp.out"),
        std::map<std::string, std::string>{{"SAPHIRA_ROBOT", system_.robot()},
                                           {"SAPHIRA_DOMAIN", test::domain()}});
    mcp_in_ = open(in.c_str(), O_WRONLY | O_CLOEXEC);
  }
  ~Site() { close(mcp_in_); }

  test::System& system() { return system_; }
  Process command(const Words& words) {
    Words argv{"saphira", "--robot", system_.robot(), "--domain", test::domain()};
    argv.insert(argv.end(), words.begin(), words.end());
    return {argv, system_.folder().path("command." + std::to_string(++commands_))};
  }
  /// Calls a tool of MCP; true for a good result in time.
  bool tool(const std::string& name, const Json& arguments, bool waits = true) {
    const std::string line = Json{{"jsonrpc", "2.0"},
                                  {"id", ++calls_},
                                  {"method", "tools/call"},
                                  {"params", {{"name", name}, {"arguments", arguments}}}}
                                 .dump() +
                             "\n";
    if (write(mcp_in_, line.data(), line.size()) != static_cast<ssize_t>(line.size()))
      return false;
    const std::string mark = "\"id\":" + std::to_string(calls_) + ",";
    const auto answer = [&] {
      const std::string all = mcp_->output();
      const std::size_t at = all.find(mark);
      return at == std::string::npos ? std::string() : all.substr(at, all.find('\n', at) - at);
    };
    if (!waits)
      return true;
    return until([&] { return !answer().empty(); }) &&
           answer().find("\"isError\":false") != std::string::npos;
  }

  /// A person at a page or a terminal, who holds a key down.
  void hold_key(bool held) { held_ = held; }
  /// Waits for the condition, and does what goes on meanwhile.
  bool until(const std::function<bool()>& condition, milliseconds limit = kPatience) {
    return wait_until(
        [&] {
          if (const auto robot = robots_.take_newest())
            stamp_ = robot->stamp;
          for (const auto& sample : grants_.take()) {
            grant_ = sample.data;
            if (armed_ && (grant_.stop != before_ || grant_.estopped)) {
              arrived_ = system_.truth().cycle;
              armed_ = false;
            }
          }
          teleop::Order order;
          order.active = held_;
          order.velocity = kSpeed;
          if (const auto key = person_.drive(order, stamp_))
            keys_.write(*key);
          return condition();
        },
        limit);
  }
  /// From now on the arrival of a stop is noted.
  void arm() {
    before_ = grant_.stop;
    arrived_.reset();
    armed_ = true;
  }
  /// The cycle of the trace at which the bridge had the stop.
  const std::optional<std::uint64_t>& arrived() const { return arrived_; }
  /// The example of direct motion control in C.
  std::string c_program() {
    const std::string out = system_.folder().path("program");
    if (access(out.c_str(), X_OK) == 0)
      return out;
    const std::string source = test::source("agents/saphira_c");
    const std::string lib = test::program("../lib");
    Process compiler({"/bin/sh", "-c",
                      "cc '" + source + "/examples/direct.c' -I '" + source + "/include' -L '" +
                          lib + "' -lsfx -Wl,-rpath,'" + lib + "' -o '" + out + "'"},
                     system_.folder().path("compiler"));
    if (compiler.wait() != 0)
      throw std::runtime_error("the C program cannot be built: " + compiler.output());
    return out;
  }

  /// The robot as before the first way, near the middle of the floor.
  void tidy() {
    held_ = false;
    command({"estop", "reset"}).wait();
    command({"drive", "hand-back"}).wait();
    until([&] { return system_.still(); });
  }

 private:
  test::System system_;
  std::unique_ptr<Process> mcp_;
  int mcp_in_ = -1;
  int calls_ = 0;
  int commands_ = 0;
  bool held_ = false;
  bool armed_ = false;
  v1::StopId before_;
  std::optional<std::uint64_t> arrived_;
  v1::Stamp stamp_;
  v1::Grant grant_;
  teleop::Pilot person_{"a person"};
  bus::Reader<v1::RobotState> robots_ = system_.node().reader(bus::topics::kRobotState);
  bus::Reader<v1::Grant> grants_ = system_.node().reader(bus::topics::kGrant);
  bus::Writer<v1::MotorCommand> keys_ = system_.node().writer(bus::topics::kDriveTeleop);
};

/// The program that moves the robot, which ends with the object.
using Mover = std::unique_ptr<Process>;
struct Move {
  const char* name;
  std::function<Mover(Site&)> begin;
};
struct Stop {
  const char* name;
  std::function<bool(Site&)> stop;  ///< true where it reports success
  bool claims_rest = true;          ///< its success means that the robot stands; else the latch
};

Mover started(Process process) {
  return std::make_unique<Process>(std::move(process));
}

std::vector<Move> moves() {
  const auto command = [](Words words) {
    return [words](Site& site) { return started(site.command(words)); };
  };
  return {
      {"speed (direct)", command({"speed", "0.3"})},
      {"move (direct)", command({"move", "6"})},
      {"write (direct)",
       command({"write", "drive/direct",
                R"({"translation":"TRANSLATION_VELOCITY","velocity":0.3,"active":true})"})},
      {"C program",
       [](Site& site) {
         return std::make_unique<Process>(
             Words{site.c_program()}, site.system().folder().path("c.out"),
             std::map<std::string, std::string>{{"SAPHIRA_ROBOT", site.system().robot()},
                                                {"SAPHIRA_DOMAIN", test::domain()}});
       }},
      {"goal drive", command({"goal", "drive", "0.3"})},
      {"goal, priority 1000", command({"goal", "drive", "0.3", "--priority", "1000"})},
      {"words", command({"say", "Flakey, go forward 20 feet"})},
      {"sequence of words",
       command(
           {"say", "Flakey, go forward 20 feet and then turn around and then go forward 20 feet"})},
      {"person",
       [](Site& site) {
         site.hold_key(true);
         return Mover();
       }},
      {"MCP",
       [](Site& site) {
         site.tool("drive", {{"speed", 0.3}, {"wait_s", 0}});
         return Mover();
       }},
  };
}

std::vector<Stop> stops() {
  const auto command = [](Words words) {
    return [words](Site& site) {
      Process process = site.command(words);
      std::optional<int> code;
      site.until([&] { return (code = process.wait(milliseconds(0))).has_value(); });
      return code == 0;
    };
  };
  return {
      {"saphira goal stop", command({"goal", "stop"})},
      {"words", command({"say", "Flakey, stop"})},
      {"request of a program",
       [](Site& site) {
         bus::RequestClient client(site.system().node(), bus::topics::kDriveStop, "bench");
         bool done = false;
         client.send(bus::request("stop"),
                     [&](const v1::Answer& answer) { done = answer.code == v1::ANSWER_DONE; });
         site.until([&] {
           client.poll(BootClock::seconds());
           return done;
         });
         return done;
       }},
      {"goal of an agent",
       [](Site& site) {
         bus::GoalClient& goals = site.system().goals();
         const v1::GoalId id = goals.ask(test::goal("stop", {}));
         std::optional<v1::GoalStatus> status;
         site.until([&] {
           goals.poll();
           status = goals.status(id);
           return status && bus::ended(status->state);
         });
         return status && status->state == v1::GOAL_SUCCEEDED;
       }},
      {"MCP stop", [](Site& site) { return site.tool("stop", Json::object()); }},
      {"MCP emergency_stop", [](Site& site) { return site.tool("emergency_stop", Json::object()); },
       false},
      {"saphira estop", command({"estop"}), false},
  };
}

struct Result {
  double still = 0.0;  ///< [s] from the stop's arrival at the bridge
  bool stopped = false;
  bool success = false;
  bool moved_after = false;
  bool false_success = false;
};

Result stop(Site& site, const Move& move, const Stop& way) {
  Result result;
  site.tidy();
  const Mover mover = move.begin(site);
  if (!site.until([&] { return std::abs(site.system().truth().velocity) > 0.1; }))
    throw std::runtime_error(std::string(move.name) + " does not move the robot: " +
                             (mover ? mover->output() : std::string()));
  site.arm();
  result.success = way.stop(site);
  const std::uint64_t claimed = site.system().truth().cycle;
  std::optional<std::uint64_t> stood;
  result.stopped = site.until([&] {
    if (site.arrived())
      stood = site.system().stood_still(*site.arrived());
    return stood.has_value();
  });
  if (!result.stopped)
    return result;
  result.false_success = way.claims_rest && result.success && claimed < *stood;
  result.still = seconds_of(*stood - *site.arrived());
  const sim::TraceRow then = site.system().truth();
  site.until([&] { return site.system().truth().cycle >= then.cycle + kWatched; });
  const Pose moved = relative(then.pose_in_world, site.system().truth().pose_in_world);
  result.moved_after = moved.position().norm() > kMoved || std::abs(norm2_angle(moved.th)) > kMoved;
  return result;
}

}  // namespace

Json stop_ways() {
  double still = 0.0;
  int moved_after = 0;
  int false_success = 0;
  int failed = 0;
  Json table = Json::array();
  for (const Move& move : moves()) {
    Site site;  // near the middle of the floor
    for (const Stop& way : stops()) {
      const Result result = stop(site, move, way);
      still = std::max(still, result.still);
      moved_after += result.moved_after ? 1 : 0;
      false_success += result.false_success ? 1 : 0;
      failed += result.stopped && result.success ? 0 : 1;
      std::printf("%-24s %-22s %.1f s%s%s%s%s\n", move.name, way.name, result.still,
                  result.stopped ? "" : "  NOT STOPPED", result.success ? "" : "  NO SUCCESS",
                  result.moved_after ? "  MOVED AFTER" : "",
                  result.false_success ? "  FALSE SUCCESS" : "");
      std::fflush(stdout);
      table.push_back({{"move", move.name}, {"stop", way.name}, {"still_s", result.still}});
    }
  }
  return {{"ways", table},
          {"still_s_max", still},
          {"moved_after", moved_after},
          {"false_success", false_success},
          {"failed", failed}};
}

}  // namespace saphira::bench
