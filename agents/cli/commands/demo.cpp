// A first demonstration of the system: a simulated robot drives to a goal, with a display.
#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include "commands.hpp"
#include "environment.hpp"
#include "lps/shell/convert.hpp"
#include "run_folder.hpp"
#include "saphira/base/cycle.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/cli/deployment.hpp"
#include "saphira/cli/goal_words.hpp"
#include "saphira/cli/picture.hpp"
#include "saphira/cli/printer.hpp"
#include "saphira/cli/supervisor.hpp"
#include "saphira/cli/trace.hpp"
#include "saphira/geometry/pose.hpp"
#include "saphira/viewer/picture.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

/// In odom, which begins at the robot's start: the far side of the lobby of the shipped office,
/// past the cupboards of the corridor, the pillar and the crate.
constexpr double kGoalX = 16.0;
constexpr double kGoalY = 1.0;
constexpr double kTimeLimit = 300.0;    ///< [s] of robot time: enough for the slowest robot
constexpr double kNewsPatience = 20.0;  ///< [s] of wall time without any news
constexpr std::size_t kKeptLines = 60;
constexpr std::uint64_t kPermitted = 300;  ///< cycles of lockstep beyond the newest known one

struct DemoOptions {
  bool headless = false;
  bool lockstep = false;
  bool single_process = false;
  bool json = false;
  bool verbose = false;
  std::uint64_t seed = 1;
  double time_limit = kTimeLimit;
  std::string world;
  std::string base;
  std::string people;
  std::vector<double> goal{kGoalX, kGoalY};
  std::string trace;
};

/// Console and camera are for people: benchmarks, and runs without a person, do not need them.
bool has_console(const DemoOptions& options) {
  return !options.headless && !options.json && !options.lockstep && !options.single_process;
}

std::vector<ChildSpec> programs(const DemoOptions& options, const bus::NodeOptions& node,
                                const std::string& run, const std::string& trace) {
  Places places = find_places();
  places.run = run;
  Deployment deployment = own_deployment("demo", places, node, has_console(options));
  deployment.bus.lockstep = options.lockstep;
  std::vector<std::string> set{"seed=" + std::to_string(options.seed)};
  if (!options.world.empty()) {
    set.push_back("world=" + options.world);
    // A shipped map has the name of its world; a user's world has no map.
    set.push_back("map=" + std::string(std::filesystem::exists(config_folder() + "/maps/" +
                                                               options.world + ".map")
                                           ? options.world
                                           : "none"));
  }
  if (!options.base.empty())
    set.push_back("base=" + options.base);
  std::vector<std::string> more{"--trace", trace};
  if (options.lockstep)
    more.emplace_back("--step");
  if (!options.people.empty())
    more.insert(more.end(),
                {"--things", find_file(config_folder() + "/people", options.people, ".wld")});
  if (options.single_process)
    put_in_one(deployment);
  std::vector<ChildSpec> children = command_lines_on(node, deployment, places, set);
  // The simulator is the deployment's first program; with saphira-all there is only one.
  children.at(0).argv.insert(children.at(0).argv.end(), more.begin(), more.end());
  return children;
}

bool is_utf8() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(name);
    if (value == nullptr || *value == '\0')
      continue;
    const std::string text = value;
    return text.find("UTF-8") != std::string::npos || text.find("utf8") != std::string::npos;
  }
  return false;
}

/// The state of the robot from the bus during the drive, and its display.
class Watcher {
 public:
  /// Each cyclic topic that is read costs a run in lockstep some of its speed: the drawn map and
  /// the robot's place on it are read for a picture, and the driver for a line.
  Watcher(bus::Node& node, const Vec2& goal, bool draws, bool lines)
      : goal_(goal),
        robots_(node.reader(bus::topics::kRobotState)),
        description_(node, bus::topics::kRobotDescription) {
    picture_.set_goal(goal);
    if (draws || lines)
      grant_.emplace(node, bus::topics::kGrant);
    if (draws) {
      map_.emplace(node, bus::topics::kMap);
      registration_.emplace(node, bus::topics::kRegistration);
    }
  }

  /// True when there was a new sample.
  bool poll() {
    if (description_.poll())
      picture_.set_radius(description_->radius);
    if (grant_)
      grant_->poll();
    if (map_ && map_->poll()) {
      walls_ = viewer::plan_of(**map_).walls;
      place_walls();
    }
    if (registration_ && registration_->poll())
      place_walls();
    bool any = false;
    for (const auto& sample : robots_.take()) {
      any = true;
      robot_ = sample.data;
      take_echoes(sample.data);
    }
    return any;
  }

  bool connected() const { return robot_.has_value(); }
  double robot_time() const { return robot_ ? seconds_of(robot_->stamp.cycle) : 0.0; }

  std::string line(const std::optional<v1::GoalStatus>& status) const {
    if (!robot_)
      return "no robot yet";
    const Pose pose = lps::from_bus(robot_->pose_in_odom);
    std::string line =
        format("%6.1f s  at (%5.2f, %5.2f)  %5.2f m to go  %4.2f m/s  ", robot_time(), pose.x,
               pose.y, (goal_ - pose.position()).norm(), robot_->velocity);
    const v1::Grant* const grant = grant_ ? grant_->get() : nullptr;
    line += (grant ? std::string(name_of(grant->role)) : "?") + " drives";
    if (grant && !latched(*grant).empty())
      line += ", " + latched(*grant);
    if (grant && grant->guard != v1::GUARD_NONE)
      line += ", the guard " + std::string(name_of(grant->guard));
    line += nearest();
    if (status)
      line += "  " + bus::describe(*status);
    return line;
  }

  std::vector<std::string> picture(int columns, int rows, bool utf8) const {
    return picture_.draw(columns, rows, utf8);
  }

 private:
  struct Reading {
    std::uint64_t cycle = 0;
    double range = 0.0;
  };

  /// The walls of the map in odom, by the robot's registration.
  void place_walls() {
    std::vector<std::pair<Vec2, Vec2>> walls;
    const v1::Registration* const registration = registration_->get();
    if (registration && registration->state == v1::REGISTRATION_TRACKING)
      for (const viewer::Line& wall : walls_) {
        const Pose odom = lps::from_bus(registration->odom_in_map);
        walls.emplace_back(to_frame(odom, wall.from), to_frame(odom, wall.to));
      }
    picture_.set_walls(std::move(walls));
  }

  void take_echoes(const v1::RobotState& robot) {
    const Pose pose = lps::from_bus(robot.pose_in_odom);
    picture_.move_robot(pose);
    for (const v1::SonarReading& reading : robot.sonars) {
      if (!reading.echo) {
        newest_.erase(reading.sonar);
        continue;
      }
      newest_[reading.sonar] = {robot.stamp.cycle, reading.range};
      if (!description_)
        continue;
      for (const v1::SonarPose& sonar : description_->sonars)
        if (sonar.sonar == reading.sonar)
          picture_.add_echo(transform(compose(pose, lps::from_bus(sonar.pose_in_robot)),
                                      Vec2(static_cast<double>(reading.range), 0.0)));
    }
  }

  std::string nearest() const {
    double range = std::numeric_limits<double>::infinity();
    int sonar = 0;
    for (const auto& [index, reading] : newest_)
      if (reading.cycle + 10 > robot_->stamp.cycle && reading.range < range) {
        range = reading.range;
        sonar = index;
      }
    return std::isfinite(range) ? format("  nearest %.2f m (sonar %d)", range, sonar)
                                : std::string();
  }

  Vec2 goal_;
  Picture picture_;
  bus::Reader<v1::RobotState> robots_;
  Newest<v1::RobotDescription> description_;
  std::optional<Newest<v1::Grant>> grant_;
  std::optional<Newest<v1::FloorMap>> map_;
  std::optional<Newest<v1::Registration>> registration_;
  std::vector<viewer::Line> walls_;  ///< of the map
  std::optional<v1::RobotState> robot_;
  std::map<int, Reading> newest_;  ///< by sonar
};

/// The terminal's alternate page, for the picture; the destructor restores the first page.
class Screen {
 public:
  explicit Screen(bool wanted) : on_(wanted) {
    if (on_)
      print("\x1b[?1049h\x1b[?25l");
  }
  ~Screen() { leave(); }
  Screen& operator=(Screen&&) = delete;

  bool on() const { return on_; }
  void leave() {
    if (!on_)
      return;
    out().flush(milliseconds(100));  // the last picture belongs to the alternate page
    print("\x1b[?25h\x1b[?1049l");
    on_ = false;
  }

  void draw(const Watcher& watcher, const std::optional<v1::GoalStatus>& status,
            const std::string& address) const {
    winsize size{};
    int columns = 80;
    int rows = 24;
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0) {
      columns = size.ws_col;
      rows = size.ws_row;
    }
    std::string page = "\x1b[H";
    if (!address.empty()) {
      page += "\x1b[K" + address.substr(0, static_cast<std::size_t>(columns)) + "\r\n";
      --rows;
    }
    for (const std::string& line : watcher.picture(columns, rows - 3, utf8_))
      page += line + "\r\n";
    page += "\x1b[K" + Picture::legend(utf8_) + "\r\n";
    const std::string line = watcher.line(status);
    const auto width = static_cast<std::size_t>(columns);
    const auto [first, second] = two_lines(line, width);
    page += "\x1b[K" + first + "\r\n\x1b[K" + second.substr(0, width - 1);
    out().show(page);
  }

 private:
  bool on_;
  bool utf8_ = is_utf8();
};

class Demo {
 public:
  Demo(const DemoOptions& options, const bus::NodeOptions& node_options)
      : options_(options),
        node_options_(own_bus(node_options, "demo")),
        trace_(options.trace.empty() ? folder_.path() + "/trace.csv" : options.trace),
        supervisor_(programs(options, node_options_, folder_.path(), trace_),
                    [this](auto from, auto line) { keep(from, line); }) {}

  int run(const bus::Stop& stop) {
    if (!std::ofstream(trace_))
      throw std::invalid_argument(cannot_be(trace_, "written"));
    // Children first: they start while our node is made.
    supervisor_.start();
    // Other commands find the bus by that.
    const FoundBus found(bus_of("the demo", node_options_));
    drive(stop);
    const bool interrupted = stop.requested();
    if (screen_.on() && !address_.empty() && !interrupted)
      stay(stop);
    supervisor_.stop();
    screen_.leave();
    flush_output();
    return report(interrupted);
  }

 private:
  /// The robot waits at the console for visitors.
  void stay(const bus::Stop& stop) {
    screen_.leave();
    print("%s. The robot waits for you: %s\nCtrl-C ends it.\n",
          status_ ? bus::describe(*status_).c_str() : "the goal got no answer", address_.c_str());
    while (!stop.requested() && !supervisor_.finished())
      supervisor_.step(std::chrono::seconds(10), {stop.fd()});
  }

  void keep(std::string_view from, std::string_view line) {
    if (from == "console" && line.starts_with("open ")) {
      address_ = line;
      if (lines())
        print("%s\n", address_.c_str());
    }
    const std::string& whole = kept_.add(from, line);
    if (options_.verbose && !screen_.on())
      complain("%s\n", whole.c_str());
  }

  bool lines() const { return !screen_.on() && !options_.json; }

  void drive(const bus::Stop& stop) {
    bus::Node node(node_options_);
    Processes processes(node);
    Watcher watcher(node, Vec2(options_.goal[0], options_.goal[1]), screen_.on(), lines());
    bus::GoalClient goals(node, "saphira demo");
    auto permits = node.writer(bus::topics::kStepPermit);

    v1::Goal goal{.functor = "go_to"};
    goal.arguments = {
        bus::point("position", options_.goal[0], options_.goal[1], 0.0, v1::FRAME_ODOM)};
    goal.deadline = options_.time_limit;
    const v1::GoalId id = goals.ask(goal);
    if (lines()) {
      print("robot %s on domain %u: saphira --robot %s --domain %u status shows it\n",
            node_options_.robot.c_str(), node_options_.domain, node_options_.robot.c_str(),
            node_options_.domain);
      print("goal %s, in %.0f s at most\n", describe(goal).c_str(), options_.time_limit);
    }

    // In lockstep the goal is there before the first step, so that it is accepted at the same cycle
    // in every run.
    const auto asked = Clock::now();
    while (!goals.delivered(100)) {
      supervisor_.step(milliseconds(0));
      if (stop.requested() || supervisor_.misused() || gave_up(asked, processes))
        return;
      processes.poll();
    }
    std::uint64_t permitted = 0;
    // Not far beyond the goal's newest status: a minute after its end there is none.
    const auto permit = [&] {
      const std::uint64_t until = kPermitted + (status_ ? status_->stamp.cycle : 0);
      if (!options_.lockstep || until < permitted + kPermitted / 3)
        return;
      permits.write({.source = "saphira demo", .until_cycle = permitted = until});
    };
    permit();

    auto began = Clock::now();
    bool accepted = false;
    auto news = Clock::now();
    auto shown = Clock::now() - std::chrono::hours(1);
    double shown_time = -1e9;
    while (!stop.requested()) {
      supervisor_.step(milliseconds(200), {stop.fd(), node.wake_fd()});
      node.clear_wake();
      processes.poll();
      goals.poll();
      if (watcher.poll())
        news = Clock::now();
      status_ = goals.status(id);
      permit();
      if (status_ && !accepted) {
        accepted = true;
        if (!options_.lockstep)
          began = Clock::now();
      }
      if (status_ && bus::ended(status_->state)) {
        wall_ = seconds_since(began);
        show(watcher);
        break;
      }
      // Once a second of robot time, and no more often than a person can read.
      const double wall = seconds_since(shown);
      if (screen_.on()
              ? wall > 0.1
              : wall > 0.1 && watcher.connected() && watcher.robot_time() >= shown_time + 1.0) {
        show(watcher);
        shown = Clock::now();
        shown_time = std::floor(watcher.robot_time());
      }
      if (supervisor_.misused() || gave_up(news, processes))
        return;
    }
    late_cycles_ = processes.late_cycles();
  }

  void show(const Watcher& watcher) {
    if (screen_.on())
      screen_.draw(watcher, status_, address_);
    else if (lines())
      print("%s\n", watcher.line(status_).c_str());
  }

  bool gave_up(Clock::time_point last_news, const Processes& processes) {
    if (seconds_since(last_news) < kNewsPatience)
      return false;
    trouble_ = "nothing was heard for " + std::to_string(static_cast<int>(kNewsPatience)) +
               " s: " + who_is_there(processes);
    return true;
  }

  int report(bool interrupted) {
    Summary summary;
    summary.arrived = status_ && status_->state == v1::GOAL_SUCCEEDED;
    const bool ended = status_ && bus::ended(status_->state);
    summary.track = evaluate_trace(
        read_file(trace_), ended ? status_->stamp.cycle : std::numeric_limits<std::uint64_t>::max(),
        trace_);
    summary.time = status_ ? status_->elapsed : 0.0;
    summary.late_cycles = late_cycles_;
    summary.speed_factor = wall_ > 0.0 ? summary.time / wall_ : 0.0;

    std::string outcome = status_ ? bus::describe(*status_) : "the goal got no answer";
    const auto misused = supervisor_.misused();
    bool crashed = false;
    for (const Supervisor::Child& child : supervisor_.children()) {
      if (!child.crashed)
        continue;
      crashed = true;
      trouble_ += (trouble_.empty() ? "" : "; ") + child.name + " crashed: " + child.ended;
    }
    if (interrupted)
      outcome = "interrupted; " + outcome;
    if (misused) {
      // Of the other programs, which wait for it or do not take the same, nothing.
      for (const std::string& line : kept_.lines())
        if (line.starts_with(*misused + " | "))
          std::fprintf(stderr, "%s\n", line.c_str());
      std::fprintf(stderr, "saphira: %s refuses its options\n", misused->c_str());
      return bus::kExitUsage;
    }
    std::FILE* out = options_.json ? stderr : stdout;
    std::fprintf(out, "%s: %s\n", summary.arrived ? "arrived" : "did not arrive", outcome.c_str());
    if (summary.track.cycles > 0)
      std::fputs(to_text(summary).c_str(), out);
    if (!trouble_.empty())
      std::fprintf(stderr, "saphira: %s\n", trouble_.c_str());
    if (!summary.arrived && !interrupted && !options_.verbose) {
      std::fputs("the last that the programs said:\n", stderr);
      for (const std::string& line : kept_.lines())
        std::fprintf(stderr, "  %s\n", line.c_str());
    }
    if (options_.json)
      std::printf("%s\n", to_json(summary).c_str());
    std::fflush(stdout);
    return summary.arrived && !crashed ? bus::kExitOk : bus::kExitFailed;
  }

  DemoOptions options_;
  bus::NodeOptions node_options_;
  RunFolder folder_;
  std::string trace_;
  Kept kept_{kKeptLines};
  Screen screen_{!options_.headless && !options_.json && isatty(STDOUT_FILENO) != 0};
  Supervisor supervisor_;
  std::optional<v1::GoalStatus> status_;
  double wall_ = 0.0;
  std::uint64_t late_cycles_ = 0;
  std::string trouble_;
  std::string address_;  ///< "open http://...", from the console
};

}  // namespace

void add_demo(CLI::App& app, Chosen& chosen) {
  auto options = std::make_shared<DemoOptions>();
  CLI::App* command = app.add_subcommand("demo", "A simulated robot drives to a goal in an office");
  chosen.apart.insert(command);
  command->add_flag("--headless", options->headless, "lines in place of the picture");
  command->add_option("--seed", options->seed, "of the simulator's noise")
      ->check(whole<std::uint64_t>())
      ->capture_default_str();
  command->add_flag("--lockstep", options->lockstep,
                    "step by step, as fast as the machine can; every run of a seed is the same");
  command->add_flag("--single-process", options->single_process, "all services in one process");
  command->add_flag("--json", options->json, "the summary as JSON on the last line");
  command->add_option("--time-limit", options->time_limit, "[s] of robot time")
      ->check(above_zero())
      ->transform(number_in_unit("s"))
      ->capture_default_str();
  command->add_option("--world", options->world,
                      "in place of the office: a name of config/worlds, or a file");
  command->add_option("--base", options->base,
                      "in place of the Pioneer 1: a name of config/robots, or a file");
  command->add_option("--people", options->people,
                      "who is in the way: standing, or another file of things of config/people");
  command->add_option("--goal", options->goal, "X Y [m], seen from where the robot starts")
      ->expected(2)
      ->transform(number_in_unit("m"))
      ->capture_default_str();
  command->add_option("--trace", options->trace, "keep the true trajectory in this file (CSV)");
  command->add_flag("--verbose,-v", options->verbose, "show the output of the programs");
  command->footer("Exit code 0: the robot arrived; 1: it did not, in the time that was given.");
  chosen.when(command, [options](const bus::NodeOptions& node, const bus::Stop& stop) {
    return Demo(*options, node).run(stop);
  });
}

}  // namespace saphira::cli
