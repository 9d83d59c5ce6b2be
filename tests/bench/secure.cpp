// The cost of security: the round trip over a secured bus compared with an open one, and the CPU
// time of the secured demo while its robot stands.
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/security/authority.hpp"
#include "support/process.hpp"

using namespace saphira;
using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

namespace {

constexpr std::uint32_t kDomain = 198;

bus::NodeOptions options_of(const std::string& program, const std::string& security) {
  bus::NodeOptions options;
  options.name = program;
  options.program = program;
  options.robot = security == bus::kOpenBus ? "open" : "secured";
  options.domain = kDomain;
  options.security = security;
  return options;
}

/// Answers each command with a state of its number, until it is ended.
[[noreturn]] void echo(const std::string& security) {
  bus::Node node(options_of("bridge", security));
  auto commands = node.reader(bus::topics::kDriveTeleop);
  auto states = node.writer(bus::topics::kRobotState);
  v1::RobotState state;
  for (;;) {
    node.wait(milliseconds(1000));
    commands.visit([&](const v1::MotorCommand& command, const bus::SampleInfo&) {
      state.stamp().cycle(command.number());
      states.write(state);
    });
  }
}

/// One side of the comparison.
class RoundTrip {
 public:
  RoundTrip(const std::string& self, const std::string& security)
      : echo_({self, "--echo", security}),
        node_(options_of("bench", security)),
        commands_(node_.writer(bus::topics::kDriveTeleop)),
        states_(node_.reader(bus::topics::kRobotState)) {
    const auto end = Clock::now() + std::chrono::seconds(30);
    while (!ping(milliseconds(50)))
      if (Clock::now() > end)
        throw std::runtime_error("no answer over the bus with security " + security);
  }

  void measure() {
    if (const auto time = ping(milliseconds(500)))
      times_.push_back(*time);
  }
  double quantile(double share) {
    std::sort(times_.begin(), times_.end());
    return times_.empty()
               ? 0.0
               : times_[static_cast<std::size_t>(share * static_cast<double>(times_.size() - 1))];
  }
  std::size_t answered() const { return times_.size(); }

 private:
  /// [us]
  std::optional<double> ping(milliseconds limit) {
    v1::MotorCommand command;
    command.number(++number_);
    const auto began = Clock::now();
    commands_.write(command);
    while (Clock::now() - began < limit) {
      node_.wait(limit);
      bool answered = false;
      states_.visit([&](const v1::RobotState& state, const bus::SampleInfo&) {
        answered = answered || state.stamp().cycle() == number_;
      });
      if (answered)
        return std::chrono::duration<double, std::micro>(Clock::now() - began).count();
    }
    return std::nullopt;
  }

  const bench::Child echo_;
  bus::Node node_;
  bus::Writer<v1::MotorCommand> commands_;
  bus::Reader<v1::RobotState> states_;
  std::uint64_t number_ = 0;
  std::vector<double> times_;
};

/// Makes a site below that folder; returns the folder of the benchmark's credentials.
std::string credentials_in(const std::string& folder) {
  const std::string roles = config_folder() + "/security/roles.yaml";
  const std::int64_t now = std::chrono::duration_cast<std::chrono::seconds>(
                               std::chrono::system_clock::now().time_since_epoch())
                               .count();
  return security::Authority::make(folder, "bench", read_file(roles), roles, now)
      .add("bench", {"bridge", "services", "operator"}, "", 1, now);
}

double idle_cpu_percent(const std::string& security, unsigned seconds) {
  setenv("SAPHIRA_DOMAIN", std::to_string(kDomain - 1).c_str(), 1);
  setenv("SAPHIRA_ROBOT", "bench-secure", 1);
  setenv("SAPHIRA_SECURITY", security.c_str(), 1);
  const bench::Child up({"saphira", "up", "demo"});
  sleep(6);  // past discovery and the connection to the robot
  const std::vector<pid_t> processes = bench::family(up.pid());
  if (processes.size() < 5)
    throw std::runtime_error("the demo did not come up");
  const auto used = [&] {
    double sum = 0.0;
    for (const pid_t pid : processes)
      sum += bench::cpu_seconds(pid);
    return sum;
  };
  const double before = used();
  sleep(seconds);
  return 100.0 * (used() - before) / seconds;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app{"Cost of security: round trip beside an open bus, and the idle demo"};
  bool json = false;
  int pings = 500;
  unsigned seconds = 20;
  std::string answering;
  app.add_flag("--json", json, "one JSON object on the last line");
  app.add_option("--pings", pings, "round trips on each bus").in_range(10, 100000);
  app.add_option("--seconds", seconds, "how long to watch the idle demo; 0: not").in_range(0, 3600);
  app.add_option("--echo", answering, "be the other process").hidden();
  if (const auto code = app.parse(argc, argv))
    return *code;
  if (!answering.empty())
    echo(answering);

  const test::TempDir folder;
  const std::string credentials = credentials_in(folder.path("site"));
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  nlohmann::json result;
  {
    RoundTrip open(self, bus::kOpenBus);
    RoundTrip secured(self, credentials);
    for (int i = 0; i < pings; ++i) {
      open.measure();
      secured.measure();
      usleep(5000);
    }
    std::printf("open     p50 %6.0f us  p99 %6.0f us  %zu of %d answered\n", open.quantile(0.5),
                open.quantile(0.99), open.answered(), pings);
    std::printf("secured  p50 %6.0f us  p99 %6.0f us  %zu of %d answered\n", secured.quantile(0.5),
                secured.quantile(0.99), secured.answered(), pings);
    result = {{"open_p50_us", open.quantile(0.5)},
              {"open_p99_us", open.quantile(0.99)},
              {"secure_p50_us", secured.quantile(0.5)},
              {"secure_p99_us", secured.quantile(0.99)},
              {"ratio_p50", secured.quantile(0.5) / open.quantile(0.5)}};
    std::printf("ratio    p50 %6.2f\n", secured.quantile(0.5) / open.quantile(0.5));
  }
  if (seconds > 0) {
    const double idle = idle_cpu_percent(credentials, seconds);
    std::printf("idle demo, secured: %.2f %% of a core\n", idle);
    result["idle_cpu_percent"] = idle;
  }
  if (json)
    std::printf("%s\n", result.dump().c_str());
  return 0;
}
