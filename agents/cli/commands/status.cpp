#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>
#include <stdexcept>

#include "commands.hpp"
#include "saphira/base/heartbeat.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

constexpr double kSlow = 1.5;       ///< [s] the status of each program comes once a second
constexpr double kStarting = 15.0;  ///< [s] longer than any time of listening

/// The status of all programs, and the driver of the robot.
class StatusView {
 public:
  explicit StatusView(bus::Node& node) : node_(node), processes_(node) {}

  void poll() {
    processes_.poll();
    if (auto grant = grants_.take_newest())
      grant_ = std::move(grant);
    if (const auto robot = robots_.take_newest()) {
      // A robot in single step may stand still.
      robot_ = robot->stamp;
      robot_came_ = Clock::now();
    }
    if (const auto behaviors = behaviors_.take_newest())
      behaved_ = behaviors->stamp;
    if (const auto intentions = intentions_.take_newest())
      intended_ = intentions->stamp;
    keep_newest(goals_, statuses_, [](const v1::GoalStatus& goal) {
      return std::pair(goal.id.writer, goal.id.number);
    });
    for (const auto& sample : log_.take())
      if (sample.data.text.starts_with(kStartedAgain))
        started_again_[sample.data.instance] = sample.data.name + " was " + sample.data.text;
  }

  std::string text() const {
    const auto all = processes_.all();
    if (all.empty())
      return who_is_there(processes_) + "\n" + silent_peers();
    const situation::Situation now = situation();
    std::string text = status_table(all, unheard(now));
    text += "drive: " + driver(now) + "\n";
    if (const std::string trouble = situation::trouble(now); !trouble.empty())
      text += "trouble: " + trouble + "\n";
    if (const std::string second = second_deployment(all); !second.empty())
      text += second + "\n";
    text += situation::clocks_apart(all);
    for (const auto& [instance, words] : started_again_)
      text += words + "\n";
    return text + silent_peers();
  }

  situation::Situation situation() const {
    situation::Situation now = processes_.situation();
    now.now = robot_.cycle;
    now.cycle = now.now;
    now.grant = grant_;
    now.silence = seconds_since(robot_came_);
    const auto known = [this](const v1::Stamp& stamp) {
      const std::uint64_t cycle = stamp.epoch == robot_.epoch ? stamp.cycle : 0;
      return situation::Known{cycle, cycle};
    };
    now.behaviors_known = known(behaved_);
    now.intentions_known = known(intended_);
    for (const auto& [id, status] : statuses_)
      now.statuses.push_back(status);
    return now;
  }

  /// Rises with all that is noticed, and again when it is heard.
  std::size_t news() const {
    const auto heard = [](const v1::Stamp& stamp) { return stamp.cycle > 0 ? 1U : 0U; };
    return processes_.news() + robots_.matched() + behaviors_.matched() + intentions_.matched() +
           heard(robot_) + heard(behaved_) + heard(intended_);
  }

  const Processes& processes() const { return processes_; }
  /// Somebody is heard, and no program misses another.
  bool whole() const { return !processes_.all().empty() && !misses(situation()); }

 private:
  std::string silent_peers() const {
    std::string text;
    for (const auto& peer : node_.silent_peers())
      text += "peer " + peer +
              ": nothing is heard from it; there, `saphira up` needs profile wan and domain " +
              std::to_string(node_.options().domain) + ", and a network that lets UDP through\n";
    for (const auto& wait : node_.network_waits())
      text += "network: " + wait + "\n";
    return text;
  }

  bus::Node& node_;
  Processes processes_;
  bus::Reader<v1::Grant> grants_ = node_.reader(bus::topics::kGrant);
  bus::Reader<v1::RobotState> robots_ = node_.reader(bus::topics::kRobotState);
  bus::Reader<v1::BehaviorSet> behaviors_ = node_.reader(bus::topics::kBehaviors);
  bus::Reader<v1::Intentions> intentions_ = node_.reader(bus::topics::kIntentions);
  bus::Reader<v1::GoalStatus> goals_ = node_.reader(bus::topics::kGoalStatus);
  bus::Reader<v1::LogRecord> log_ = node_.reader(bus::topics::kLog);
  std::optional<v1::Grant> grant_;
  v1::Stamp robot_, behaved_, intended_;  ///< the newest
  Clock::time_point robot_came_ = Clock::now();
  std::map<std::pair<std::uint64_t, std::uint64_t>, v1::GoalStatus> statuses_;
  std::map<std::uint64_t, std::string> started_again_;  ///< by the supervisor, with the reason
};

int status(bool watch, bool json, const bus::NodeOptions& options, const bus::Stop& stop) {
  bus::Node node(options);
  StatusView view(node);
  const auto refresh = [&view] { view.poll(); };
  const double took =
      listen(node, stop, view.processes(), refresh, [&view] { return view.news(); });
  if (json) {
    std::printf("%s\n", to_json(view.situation()).c_str());
    return view.whole() ? bus::kExitOk : bus::kExitFailed;
  }
  while (watch && !stop.requested()) {
    const bool terminal = isatty(STDOUT_FILENO) != 0;
    std::printf("%s%s%s", terminal ? "\x1b[H\x1b[2J" : "", view.text().c_str(),
                terminal ? "" : "\n");
    std::fflush(stdout);
    poll_for(node, std::chrono::seconds(1), stop, refresh);
  }
  if (!watch)
    std::fputs(view.text().c_str(), stdout);
  const auto all = view.processes().all();
  const bool starting = std::any_of(all.begin(), all.end(), [](const SeenProcess& each) {
    return each.status.uptime < kStarting;
  });
  if (!watch && took > kSlow && !starting)
    std::printf(
        "slow: the last of this was heard after %.1f s, by a network or a machine that is "
        "slow or loaded\n",
        took);
  return watch || view.whole() ? bus::kExitOk : bus::kExitFailed;
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
