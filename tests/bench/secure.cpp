// The cost of security: the round trip over a secured bus compared with an open one, and the CPU
// time of the secured demo while its robot stands. And its worth: members that forge their
// permissions, and a flood of announcements.
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench.hpp"
#include "forged.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/security/authority.hpp"
#include "support/process.hpp"
#include "support/strangers.hpp"

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
      state.stamp.cycle = command.number;
      states.write(state);
    });
  }
}

/// One side of the comparison.
class RoundTrip {
 public:
  explicit RoundTrip(const std::string& security)
      : node_(options_of("bench", security)),
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
    v1::MotorCommand command{.number = ++number_};
    const auto began = Clock::now();
    commands_.write(command);
    while (Clock::now() - began < limit) {
      node_.wait(limit);
      bool answered = false;
      states_.visit([&](const v1::RobotState& state, const bus::SampleInfo&) {
        answered = answered || state.stamp.cycle == number_;
      });
      if (answered)
        return std::chrono::duration<double, std::micro>(Clock::now() - began).count();
    }
    return std::nullopt;
  }

  bus::Node node_;
  bus::Writer<v1::MotorCommand> commands_;
  bus::Reader<v1::RobotState> states_;
  std::uint64_t number_ = 0;
  std::vector<double> times_;
};

std::int64_t now() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// Makes a site in that folder.
security::Authority site_in(const std::string& folder) {
  const std::string roles = config_folder() + "/security/roles.yaml";
  return security::Authority::make(folder, "bench", read_file(roles), roles, now());
}

/// The topics on which altered programs with forged permissions are heard by the bridge, or hear
/// others: of an observer, and of an operator of another robot.
std::size_t member_escapes(security::Authority& site, const std::string& folder) {
  const std::string bridges = site.add("escapes", {"bridge"}, "", 1, now());
  bus::NodeOptions options = options_of("bridge", bridges);
  bus::Node bridge(options);
  std::vector<std::function<void()>> turns;
  std::set<std::string> escapes;
  bus::for_each_topic([&]<class T>(const bus::Topic<T>& topic) {
    if (site.roles().may_write("bridge", topic.name))
      turns.push_back([writer = std::make_shared<bus::Writer<T>>(bridge.writer(topic))] {
        writer->write(T());
      });
    else if (site.roles().may_read("bridge", topic.name))  // nobody else is there to write it
      turns.push_back(
          [&escapes, reader = std::make_shared<bus::Reader<T>>(bridge.reader(topic)), topic] {
            if (!reader->take().empty())
              escapes.insert(topic.name);
          });
  });
  for (const auto& [role, robot] : {std::pair("observer", ""), std::pair("operator", "other")}) {
    const std::string name = std::string("liar-") + role;
    const std::string forged = folder + "/" + name;
    std::filesystem::copy(site.add(name, {role}, robot, 1, now()), forged,
                          std::filesystem::copy_options::recursive);
    security::test::forge(forged, {{name, 1, role, "bench"}, "", now() - 60, now() + 3600},
                          site.roles(), security::test::pair_of(forged, role));
    test::Process liar({"saphira-bus-altered", "--name", name}, folder + "/said",
                       {{"SAPHIRA_DOMAIN", std::to_string(kDomain)},
                        {"SAPHIRA_ROBOT", options.robot},
                        {"SAPHIRA_SECURITY", forged}});
    for (const auto end = Clock::now() + std::chrono::seconds(5); Clock::now() < end;) {
      for (const auto& turn : turns)
        turn();
      bridge.wait(milliseconds(50));
    }
    if (!liar.running())
      throw std::runtime_error("the altered program has ended: " + liar.output());
    if (liar.output().find("hears ") != std::string::npos)
      escapes.insert(liar.output());
  }
  return escapes.size();
}

/// 10,000 forged announcements within 10 s, then a member who joins.
nlohmann::json flood(const std::string& self, const std::string& credentials,
                     const std::string& folder) {
  test::Process victim({self, "--echo", credentials}, folder + "/victim");
  test::Strangers strangers(kDomain);
  strangers.announce(10000, 1000);
  const auto began = Clock::now();
  const RoundTrip joiner(credentials);
  const double joined = std::chrono::duration<double>(Clock::now() - began).count();
  return {{"aborts", victim.running() ? 0 : 1},
          {"joined_s", joined},
          {"flooded_mb", bench::resident_mb(victim.pid())}};
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
  bool attack = true;
  std::string answering;
  app.add_flag("--json", json, "one JSON object on the last line");
  app.add_option("--pings", pings, "round trips on each bus").in_range(10, 100000);
  app.add_option("--seconds", seconds, "how long to watch the idle demo; 0: not").in_range(0, 3600);
  app.add_flag("!--no-attack", attack, "without forged permissions and the flood");
  app.add_option("--echo", answering, "be the other process").hidden();
  if (const auto code = app.parse(argc, argv))
    return *code;
  if (!answering.empty())
    echo(answering);

  const test::TempDir folder;
  security::Authority site = site_in(folder.path("site"));
  const std::string credentials =
      site.add("bench", {"bridge", "services", "operator"}, "", 1, now());
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  nlohmann::json result;
  {
    const bench::Child open_echo({self, "--echo", bus::kOpenBus});
    const bench::Child secured_echo({self, "--echo", credentials});
    RoundTrip open(bus::kOpenBus);
    RoundTrip secured(credentials);
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
  if (attack) {
    result["member_escapes"] = member_escapes(site, folder.path());
    result.update(flood(self, credentials, folder.path()));
    std::printf(
        "forged permissions: %zu topics written or read\n"
        "10,000 forged announcements: %d programs ended, a member joined in %.2f s, %.0f MB\n",
        result["member_escapes"].get<std::size_t>(), result["aborts"].get<int>(),
        result["joined_s"].get<double>(), result["flooded_mb"].get<double>());
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
