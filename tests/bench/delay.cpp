// The cost of a slow network: simulator and bridge on one host, the intentions on another, and a
// link between them that delays and loses frames. Measured: the distance of the robot in 20 s, by
// the simulator's trace, and the time to its standstill after the link is cut.
#include <stdlib.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "bench.hpp"
#include "network/slow_link.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/sim/trace.hpp"
#include "support/guarded.hpp"
#include "support/process.hpp"

using namespace saphira;
namespace fs = std::filesystem;

namespace {

constexpr double kCycle = 0.1;     // [s]
constexpr double kMoves = 0.05;    // [m/s]
constexpr double kStands = 0.005;  // [m/s]
constexpr int kSkipped = 77;

struct Options {
  bool json = false;
  bool why = false;
  std::string behaviors = "robot";
  std::vector<double> delays{0, 50, 100, 250};
  std::vector<double> losses{0, 5};
  double seconds = 20.0;
};

std::vector<sim::TraceRow> read_trace(const std::string& path) {
  if (!fs::exists(path))
    return {};
  return sim::parse_trace(read_file(path), path);
}

/// Reads the trace until the condition holds, for that time at most; true where it held.
bool wait_for(const std::string& trace, double seconds,
              const std::function<bool(const std::vector<sim::TraceRow>&)>& what) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < end) {
    if (what(read_trace(trace)))
      return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

struct Result {
  double meters = 0.0;
  double stood = 0.0;             ///< [0..1] of the time
  std::optional<double> stand_s;  ///< from the cut
  std::string why;
};

class Host {
 public:
  Host(const test::SlowLink& link, int number) : link_(link), number_(number) {}
  bench::Child start(std::vector<std::string> argv) const {
    setenv("SAPHIRA_INTERFACE", test::SlowLink::address(number_), 1);
    return bench::Child(std::move(argv), link_.network(number_));
  }
  std::string ask(const std::vector<std::string>& argv) const {
    setenv("SAPHIRA_INTERFACE", test::SlowLink::address(number_), 1);
    return bench::output_of(argv, link_.network(number_));
  }

 private:
  const test::SlowLink& link_;
  int number_;
};

Result drive(test::SlowLink& link, const Options& options, double delay, double loss) {
  const test::TempDir folder;
  const std::string trace = folder.path("trace.csv");
  const std::string socket = folder.path("robot");
  Result result;
  link.cut(false);
  link.set(delay, loss);
  const Host robot(link, 0);
  const Host laptop(link, 1);
  const std::string config = config_folder();
  const bench::Child simulator =
      robot.start({"saphira-sim", "--world", config + "/worlds/office.wld", "--robot-file",
                   config + "/robots/pioneer.p", "--socket", socket, "--trace", trace});
  const bench::Child bridge =
      robot.start({"saphira-bridge", "--link", socket, "--robots", config + "/robots"});
  const bench::Child behaviors =
      (options.behaviors == "robot" ? robot : laptop).start({"saphira-behaviors"});
  const bench::Child intentions =
      laptop.start({"saphira-intentions", "--no-registration", "--no-interpretation"});
  const bench::Child goal = laptop.start({"saphira", "goal", "go", "16", "1"});

  const auto moves = [](const std::vector<sim::TraceRow>& rows) {
    return !rows.empty() && rows.back().velocity > kMoves;
  };
  std::size_t begin = 0;
  wait_for(trace, 30.0, moves);
  begin = read_trace(trace).size();
  const auto cycles = static_cast<std::size_t>(std::lround(options.seconds / kCycle));
  if (options.why) {
    wait_for(trace, options.seconds, [&](const auto& rows) { return rows.size() > begin + 50; });
    try {
      result.why = laptop.ask({"saphira", "why"});
    } catch (const std::exception& error) {
      result.why = error.what();
    }
  }
  wait_for(trace, 2.0 * options.seconds,
           [&](const auto& rows) { return rows.size() > begin + cycles; });
  link.cut(true);
  const std::vector<sim::TraceRow> rows = read_trace(trace);
  std::size_t stood = 0;
  for (std::size_t i = begin + 1; i < std::min(rows.size(), begin + cycles + 1); ++i) {
    result.meters +=
        (rows[i].pose_in_world.position() - rows[i - 1].pose_in_world.position()).norm();
    stood += std::abs(rows[i].velocity) < kStands ? 1 : 0;
  }
  result.stood = static_cast<double>(stood) / static_cast<double>(cycles);
  // The standstill counts after a second.
  const std::size_t cut = rows.size();
  wait_for(trace, 10.0, [&](const std::vector<sim::TraceRow>& all) {
    std::size_t still = 0;
    for (std::size_t i = cut; i < all.size(); ++i) {
      still = std::abs(all[i].velocity) < kStands ? still + 1 : 0;
      if (still == 10)
        result.stand_s = kCycle * static_cast<double>(i - 9 - cut);
    }
    return result.stand_s.has_value();
  });
  return result;
}

std::string name_of(double delay, double loss) {
  char text[64];
  if (loss > 0.0)
    std::snprintf(text, sizeof text, "at_%g_loss%g", delay, loss);
  else
    std::snprintf(text, sizeof text, "at_%g", delay);
  return text;
}

int measure(test::SlowLink& link, const Options& options) {
  setenv("SAPHIRA_DOMAIN", "197", 1);
  setenv("SAPHIRA_ROBOT", ("bench" + std::to_string(getpid())).c_str(), 1);
  setenv("SAPHIRA_PROFILE", "lan", 1);
  nlohmann::ordered_json json;
  std::printf("behaviors on the %s; %.0f s each\n", options.behaviors.c_str(), options.seconds);
  for (const double loss : options.losses)
    for (const double delay : options.delays) {
      const Result result = drive(link, options, delay / 1000.0, loss / 100.0);
      const std::string name = name_of(delay, loss);
      std::printf("%4.0f ms each way, %2.0f %% lost: %5.2f m, stood %3.0f %% of the time, ", delay,
                  loss, result.meters, 100.0 * result.stood);
      std::printf(result.stand_s ? "stands %.1f s after the cut\n" : "does not stand after a cut\n",
                  result.stand_s.value_or(0.0));
      if (!result.why.empty())
        std::printf("%s\n", result.why.c_str());
      std::fflush(stdout);
      json["m_" + name] = result.meters;
      json["stood_" + name] = result.stood;
      json["stand_s_" + name] = result.stand_s ? nlohmann::json(*result.stand_s) : nullptr;
    }
  if (options.json)
    std::printf("%s\n", json.dump().c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app{"What a slow network between the robot and its services costs"};
  Options options;
  app.add_flag("--json", options.json, "one JSON object on the last line");
  app.add_flag("--why", options.why, "what `saphira why` says meanwhile");
  app.add_option("--behaviors", options.behaviors, "on which host the behaviors service runs")
      .one_of({"robot", "laptop"});
  app.add_option("--delay", options.delays, "[ms] each way").in_range(0.0, 5000.0);
  app.add_option("--loss", options.losses, "[%] of all frames, each way").in_range(0.0, 100.0);
  app.add_option("--seconds", options.seconds, "of each run").in_range(1.0, 3600.0);
  if (const auto code = app.parse(argc, argv))
    return *code;
  std::optional<test::SlowLink> link;
  try {
    link.emplace();
  } catch (const std::system_error& error) {
    std::fprintf(stderr,
                 "saphira-bench-delay: skipped, it needs root (for network namespaces) and "
                 "/dev/net/tun: %s\n",
                 error.what());
    return kSkipped;
  }
  return test::guarded([&] { return measure(*link, options); });
}
