// saphira-all: a simulated robot and every service, each in a thread of one process. They meet on
// the bus as separate processes do, so that anybody else can watch and join.

#include <poll.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "behaviors/shell/shell.hpp"
#include "bridge/shell/shell.hpp"
#include "intentions/shell/shell.hpp"
#include "interpretation/shell/shell.hpp"
#include "registration/shell/shell.hpp"
#include "saphira/base/places.hpp"
#include "saphira/bus/program.hpp"
#include "saphira/sim/host.hpp"

namespace {

using namespace saphira;

/// Threads that end together: when one ends, the others are stopped; what failed first is thrown
/// on.
class Crew {
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

/// The same options under the name of one service.
bus::NodeOptions named(bus::NodeOptions options, const char* name) {
  options.name = name;
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string config = config_folder();
  sim::HostOptions robot;
  robot.world = "office";
  robot.robot = "pioneer";
  bridge::BridgeOptions link;
  link.robots_folder = config + "/robots";
  // Here the simulated robot dies with whoever drives it.
  link.keeper = false;
  behaviors::ShellOptions moves;
  intentions::ShellOptions goals;
  registration::ShellOptions place;
  std::string socket = sim::default_socket();
  return bus::run_program(
      argc, argv, "all", "A simulated robot and all services in one process",
      [&](CLI::App& app) {
        app.add_option("--world", robot.world,
                       "world file of the simulator, or the name of one that is shipped")
            ->capture_default_str();
        app.add_option("--robot-file", robot.robot,
                       "parameter file of the simulated robot, or the name of one that is shipped")
            ->capture_default_str();
        app.add_option("--seed", robot.seed, "of all that is random")->capture_default_str();
        app.add_flag("--step", robot.step, "single-step from the start");
        app.add_option("--rate", robot.rate, "times real time")->capture_default_str();
        app.add_option("--trace", robot.trace, "file for the true state of every cycle, CSV");
        app.add_option("--socket,--link", socket, "local socket between simulator and bridge")
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast)
            ->capture_default_str();
        app.add_option("--robots", link.robots_folder, "folder of robot parameter files")
            ->capture_default_str();
        app.add_option("--state", link.state_file,
                       "file that keeps the robot's position over a restart");
        app.add_flag("--free-step", link.free_step, "lockstep: step without a permit");
        app.add_option("--memory", goals.memory_file,
                       "file that remembers ended goals over a restart");
        app.add_option("--behaviors", moves.folder, "folder of behavior files");
        app.add_option("--plugin", moves.plugins, "shared library with behaviors in C++");
        app.add_option("--activities", goals.folder, "folder of activity files");
        app.add_option("--map", place.map_file,
                       "map file, or the name of one that is shipped; none: an empty map");
        app.add_option("--start", place.start, "where the robot is on the map at first")
            ->capture_default_str();
        app.add_option("--map-memory", place.memory_file,
                       "file that keeps pose and map over a restart");
      },
      [&](const bus::NodeOptions& options, const bus::Stop& stop) {
        robot.world = find_file(config + "/worlds", robot.world, ".wld");
        robot.robot = find_file(config + "/robots", robot.robot, ".p");
        place.map_file = registration::find_map(place.map_file);
        robot.socket = socket;
        link.robot_port = "unix:" + socket;
        robot.log = [](const std::string& line) {
          std::fprintf(stderr, "sim: %s\n", line.c_str());
        };
        Crew crew;
        crew.add([&](const bus::Stop& end) { sim::run(robot, end.fd()); });
        crew.add(
            [&](const bus::Stop& end) { bridge::Shell(named(options, "bridge"), link).run(end); });
        crew.add([&](const bus::Stop& end) {
          bus::Node node(named(options, "behaviors"));
          behaviors::Shell(node, moves).run(end);
        });
        crew.add([&](const bus::Stop& end) {
          bus::Node node(named(options, "intentions"));
          intentions::Shell(node, goals).run(end);
        });
        crew.add([&](const bus::Stop& end) {
          bus::Node node(named(options, "interpretation"));
          interpretation::Shell(node).run(end);
        });
        crew.add([&](const bus::Stop& end) {
          bus::Node node(named(options, "registration"));
          registration::Shell(node, place).run(end);
        });
        crew.run(stop);
        return bus::kExitOk;
      });
}
