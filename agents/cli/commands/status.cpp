#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>
#include <stdexcept>

#include "commands.hpp"
#include "saphira/base/heartbeat.hpp"
#include "saphira/situation/words.hpp"
#include "saphira/watch/mind.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using watch::Mind;

constexpr double kSlow = 1.5;       ///< [s] the status of each program comes once a second
constexpr double kStarting = 15.0;  ///< [s] longer than any time of listening

/// The supervisor's words about programs that it has started again.
class Restarts {
 public:
  explicit Restarts(bus::Node& node) : log_(node.reader(bus::topics::kLog)) {}

  void poll() {
    for (const auto& sample : log_.take())
      if (sample.data.text.starts_with(kStartedAgain))
        words_[sample.data.instance] = sample.data.name + " was " + sample.data.text + "\n";
  }
  std::string text() const {
    std::string text;
    for (const auto& [instance, words] : words_)
      text += words;
    return text;
  }

 private:
  bus::Reader<v1::LogRecord> log_;
  std::map<std::uint64_t, std::string> words_;
};

std::string silent_peers(const bus::Node& node) {
  std::string text;
  for (const auto& peer : node.silent_peers())
    text += "peer " + peer +
            ": nothing is heard from it; there, `saphira up` needs profile wan and domain " +
            std::to_string(node.options().domain) + ", and a network that lets UDP through\n";
  for (const auto& wait : node.network_waits())
    text += "network: " + wait + "\n";
  return text;
}

/// All programs, the driver of the robot, and trouble.
std::string text_of(const Mind& mind, const Restarts& restarts) {
  const bus::Node& node = mind.processes().node();
  const situation::Situation now = mind.situation();
  if (now.programs.empty())
    return who_is_there(mind.processes()) + "\n" + silent_peers(node);
  std::string text = status_table(now.programs, unheard(now)) + "drive: " + driver(now) + "\n";
  if (const std::string trouble = situation::all_trouble(now); !trouble.empty())
    text += "trouble: " + trouble + "\n";
  if (const std::string second = second_deployment(now.programs); !second.empty())
    text += second + "\n";
  if (!now.found.empty())
    text += "slow: of " + situation::listed(now.found) + " no status has come yet\n";
  return text + clocks_apart(now.programs) + restarts.text() + silent_peers(node);
}

/// Somebody is heard, and no program misses another.
int code_of(const situation::Situation& now) {
  return now.programs.empty() || misses(now) ? bus::kExitFailed : bus::kExitOk;
}

int status(bool again, bool json, const bus::NodeOptions& options, const bus::Stop& stop) {
  bus::Node node(options);
  Mind mind(node, false);
  Restarts restarts(node);
  const auto refresh = [&] {
    mind.poll();
    restarts.poll();
  };
  const double took =
      watch::listen(node, stop, mind.processes(), refresh, [&] { return mind.news(); });
  const situation::Situation now = mind.situation();
  if (json) {
    std::printf("%s\n", to_json(now).c_str());
    return code_of(now);
  }
  while (again && !stop.requested()) {
    const bool terminal = isatty(STDOUT_FILENO) != 0;
    std::printf("%s%s%s", terminal ? "\x1b[H\x1b[2J" : "", text_of(mind, restarts).c_str(),
                terminal ? "" : "\n");
    std::fflush(stdout);
    poll_for(node, std::chrono::seconds(1), stop, refresh);
  }
  if (again)
    return bus::kExitOk;
  std::fputs(text_of(mind, restarts).c_str(), stdout);
  const bool starting = std::ranges::any_of(
      now.programs, [](const situation::Program& each) { return each.status.uptime < kStarting; });
  if (took > kSlow && !starting)
    std::printf(
        "slow: the last of this was heard after %.1f s, by a network or a machine that is "
        "slow or loaded\n",
        took);
  return code_of(now);
}

/// Each robot with a program that works for it, one robot after another.
int status_of_each(bus::NodeOptions options, const bus::Stop& stop) {
  const std::set<std::string> works{bus::topics::kGrant.name, bus::topics::kPerception.name,
                                    bus::topics::kBehaviors.name, bus::topics::kIntentions.name};
  const std::set<std::string> robots =
      robots_heard(options, stop, [&works](const bus::EndpointEntry& entry) {
        return entry.writer && works.contains(entry.topic);
      });
  if (robots.empty())
    return failed("no robot is heard in domain " + std::to_string(options.domain));
  int code = bus::kExitOk;
  for (const std::string& robot : robots) {
    options.robot = robot;
    std::printf("%s:\n", called(robot).c_str());
    code = std::max(code, status(false, false, options, stop));
  }
  return code;
}

}  // namespace

void add_status(CLI::App& app, Chosen& chosen) {
  auto watch = std::make_shared<bool>(false);
  auto json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("status", "Every process, and who drives and why");
  chosen.reach[command] = {"status"};
  command->add_flag("--watch,-w", *watch, "again each second, until Ctrl-C");
  command->add_flag("--json", *json, "one JSON object: programs, drive, goals, trouble")
      ->excludes("--watch");
  chosen.when(command, [watch, json](const bus::NodeOptions& node, const bus::Stop& stop) {
    if (node.robot != kEveryRobot)
      return status(*watch, *json, node, stop);
    if (*watch || *json)
      throw std::invalid_argument("--watch and --json are of one robot: --robot NAME");
    return status_of_each(node, stop);
  });
}

}  // namespace saphira::cli
