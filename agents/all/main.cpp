// saphira-all: a simulated robot and every service in one process. Live, each has a thread, and
// they meet on the bus as separate processes do. In lockstep they take turns in one thread, and a
// gateway lets other programs watch and send commands.

#include <poll.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "agent_interface/shell/dialogue_shell.hpp"
#include "bridge/shell/shell.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/cycle.hpp"
#include "saphira/base/fnv1a.hpp"
#include "saphira/base/log_line.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/gateway.hpp"
#include "saphira/bus/program.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/runtime/composition.hpp"
#include "saphira/sim/host.hpp"
#include "story/shell/story.hpp"
#include "system/system.hpp"

namespace {

using namespace saphira;

/// Threads that end together: when one ends, the others are stopped; the first exception is
/// rethrown.
class Threads {
 public:
  void add(std::function<void(const bus::Stop&)> work) {
    threads_.emplace_back([this, work = std::move(work)] {
      try {
        work(stop_);
      } catch (...) {
        const std::scoped_lock lock(mutex_);
        if (!failure_)
          failure_ = std::current_exception();
      }
      stop_.request();
    });
  }

  void run(const bus::Stop& from_outside) {
    std::array<pollfd, 2> ends{{{from_outside.fd(), POLLIN, 0}, {stop_.fd(), POLLIN, 0}}};
    while (poll(ends.data(), ends.size(), -1) < 0) {
    }
    stop_.request();
    threads_.clear();  // joins
    if (failure_)
      std::rethrow_exception(failure_);
  }

 private:
  bus::Stop stop_;
  std::mutex mutex_;
  std::exception_ptr failure_;
  std::vector<std::jthread> threads_;
};

/// People who speak to the robot, and the grammar for them.
struct Talk {
  std::string grammar;  ///< a file; empty: no dialogue
  std::string people;   ///< a file of config/people; empty: no people
  double time_limit = 1200.0;
};

/// The parts that run in this process.
struct Programs {
  sim::HostOptions robot;
  bridge::BridgeOptions link;
  std::vector<runtime::Component> services;
  Talk talk;
};

/// The same options under the name of one service.
bus::NodeOptions named(bus::NodeOptions options, const std::string& name) {
  options.name = name;
  return options;
}

void run_in_threads(const Programs& programs, const bus::NodeOptions& options,
                    const bus::Stop& stop) {
  Threads threads;
  threads.add([&](const bus::Stop& end) { sim::run(programs.robot, end.fd()); });
  threads.add([&](const bus::Stop& end) {
    bridge::Shell(named(options, "bridge"), programs.link).run(end);
  });
  for (const runtime::Component& service : programs.services)
    threads.add([&](const bus::Stop& end) {
      bus::Node node(named(options, service.name));
      runtime::Shell(node, service.make).run(end);
    });
  threads.run(stop);
}

/// Dialogue and people on the in-memory bus. They take a step after each of the services, so that
/// the conversation depends on the robot's cycles alone.
class Talkers {
 public:
  Talkers(const Talk& talk, const bus::NodeOptions& options,
          const std::shared_ptr<bus::MemoryBus>& memory) {
    if (talk.grammar.empty())
      return;
    listener_.emplace(named(options, "dialogue"), memory);
    dialogue_.emplace(*listener_, agent_interface::DialogueOptions{talk.grammar, ""});
    robots_.emplace(listener_->reader(bus::topics::kRobotState));
    if (talk.people.empty())
      return;
    speaker_.emplace(named(options, "people"), memory);
    story_.emplace(*speaker_, story::Cast(read_file(talk.people), talk.people),
                   story::StoryOptions{
                       {}, talk.time_limit, [](double time, const auto& place, const auto& line) {
                         std::printf("%s\n", story::story_line(time, place, line).c_str());
                       }});
  }

  /// True when the story has come to its end.
  bool step() {
    if (dialogue_) {
      if (const auto robot = robots_->take_newest())
        seconds_ = seconds_of(robot->stamp.cycle);
      dialogue_->step(seconds_);
    }
    return story_ && story_->step();
  }

  /// The result of the story, as one line of JSON.
  void report() const {
    const nlohmann::json result{{"well", story_->well()},
                                {"handed_over", story_->handed_over()},
                                {"outcome", story_->outcome()},
                                {"time_s", std::round(10.0 * story_->time()) / 10.0},
                                {"utterances", story_->utterances()},
                                {"dialogue_hash", story_->hash()}};
    std::printf("%s\n", result.dump().c_str());
  }

 private:
  std::optional<bus::Node> listener_;
  std::optional<agent_interface::DialogueShell> dialogue_;
  std::optional<bus::Reader<v1::RobotState>> robots_;
  double seconds_ = 0.0;  ///< of the robot's cycles
  std::optional<bus::Node> speaker_;
  std::optional<story::Story> story_;
};

/// Runs everything in this thread, in rounds: simulator, bridge, services. After a round without a
/// service's step, the thread sleeps until a program outside writes a sample, at most 20 ms.
void run_in_turn(const Programs& programs, const bus::NodeOptions& options, const bus::Stop& stop) {
  using std::chrono::milliseconds;
  constexpr milliseconds kMostRest{20};
  const auto memory = bus::make_memory_bus();
  sim::Host robot(programs.robot);
  bridge::Shell bridge(named(options, "bridge"), programs.link, memory);
  runtime::Composition services(options, memory);
  for (const runtime::Component& service : programs.services)
    services.add(service.name, service.make);
  Talkers talkers(programs.talk, options, memory);
  bus::Node outside(options);
  bus::Gateway gateway(outside, memory);

  milliseconds rest{1};
  while (robot.serve(stop.fd(), 0)) {
    bridge.advance({true, true});
    const bool stepped = services.advance();
    gateway.carry();
    if (stepped) {
      if (talkers.step()) {
        talkers.report();
        break;
      }
      bridge.advance({false, true});
      rest = milliseconds(1);
      continue;
    }
    services.idle();
    gateway.wait(rest, stop);
    rest = std::min(2 * rest, kMostRest);
  }
  bridge.end();
  robot.end();
}

}  // namespace

int main(int argc, char** argv) {
  const std::string config = config_folder();
  Programs programs;
  programs.robot.world = "office";
  programs.robot.robot = "pioneer";
  programs.link.robots_folder = config + "/robots";
  // Here the simulated robot ends with its driver.
  programs.link.keeper = false;
  programs.services = system::services();
  std::string socket = sim::default_socket();
  std::optional<Option> vision;
  std::optional<Option> stereo;
  return bus::run_program(
      argc, argv, "all", "A simulated robot and all services in one process",
      [&](CommandLine& app) {
        sim::HostOptions& robot = programs.robot;
        app.add_option("--world", robot.world,
                       "world file of the simulator, or the name of one that is shipped");
        app.add_option("--things", robot.things,
                       "file of the same form with what stands and walks in that world besides");
        app.add_option("--view-socket", robot.view_socket,
                       "local socket of the simulator's own view");
        app.add_option("--camera-socket", robot.camera_socket,
                       "local socket that sends pictures in colour, for saphira-camera");
        app.add_option("--robot-file", robot.robot,
                       "parameter file of the simulated robot, or the name of one that is shipped")
            .last_wins();
        app.add_option("--seed", robot.seed, "of all that is random");
        app.add_flag("--step", robot.step, "single-step from the start");
        app.add_option("--rate", robot.rate, "times real time");
        app.add_option("--trace", robot.trace, "file for the true state of every cycle, CSV");
        app.add_option("--resume", robot.state,
                       "file for the places of all that moves, from one end to the next start");
        app.add_option("--socket,--link", socket, "local socket between simulator and bridge")
            .last_wins();
        app.add_option("--robots", programs.link.robots_folder, "folder of robot parameter files");
        app.add_option("--state", programs.link.state_file,
                       "file that keeps the robot's position over a restart");
        app.add_flag("--free-step", programs.link.free_step, "lockstep: step without a permit");
        app.add_option("--grammar", programs.talk.grammar,
                       "lockstep: the dialogue runs as well, with what people may say: a name of "
                       "config/grammars, or a file");
        app.add_option("--people", programs.talk.people,
                       "the people of a story, who speak to the robot: a name of config/people, or "
                       "a file; it ends with the story, and its last line tells how, as JSON")
            .needs(app.option("--grammar"));
        app.add_option("--time-limit", programs.talk.time_limit,
                       "[s] of robot time, for the story");
        for (const runtime::Component& service : programs.services)
          if (service.add_options)
            service.add_options(app);
        vision = app.option("--vision").describe("vision runs as well");
        stereo =
            app.option("--stereo-socket")
                .describe("local socket on which the simulator sends stereo pictures to vision")
                .last_wins();
      },
      [&](const bus::NodeOptions& options, const bus::Stop& stop) {
        programs.robot.world = find_file(config + "/worlds", programs.robot.world, ".wld");
        programs.robot.robot = find_file(config + "/robots", programs.robot.robot, ".p");
        programs.link.parameter_file = programs.robot.robot;
        programs.robot.socket = socket;
        if (stereo->given())
          programs.robot.stereo_socket = stereo->text();
        programs.link.robot_port = "unix:" + socket;
        programs.robot.log = [](std::string_view level, const std::string& text) {
          const std::string line = log_line(unix_time(), level, "sim", text);
          std::fprintf(stderr, "%s\n", line.c_str());
        };
        Talk& talk = programs.talk;
        if (!talk.grammar.empty()) {
          if (!options.lockstep)
            throw std::invalid_argument("--grammar: in one process the dialogue needs --lockstep");
          talk.grammar = find_file(config + "/grammars", talk.grammar, ".grammar");
        }
        if (!talk.people.empty())
          talk.people = find_file(config + "/people", talk.people, ".people");
        if (!vision->given())
          std::erase_if(programs.services, [](const auto& one) { return one.name == "vision"; });
        if (options.lockstep)
          run_in_turn(programs, options, stop);
        else
          run_in_threads(programs, options, stop);
        return bus::kExitOk;
      });
}
