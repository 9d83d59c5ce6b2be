#include "lockstep.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <utility>

#include "node_options.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"

namespace saphira::test {

LockstepSystem::LockstepSystem(const Scene& scene) : node(node_options("test", robot, true)) {
  const std::string world = folder.path("world.wld");
  std::ofstream(world) << scene.world;
  const std::string map = scene.map.empty() ? "none" : source("config/maps/" + scene.map + ".map");
  const std::string robot_file = find_file(source("config/robots"), scene.robot, ".p");
  if (scene.single_process) {
    on_bus({"saphira-all", "--world", world, "--robot-file", robot_file, "--socket",
            folder.path("robot"), "--trace", folder.path("trace.csv"), "--seed", "1", "--step",
            "--robots", source("config/robots"), "--map", map});
    return;
  }
  std::vector<std::string> simulator{"saphira-sim",  "--step",
                                     "--world",      world,
                                     "--robot-file", robot_file,
                                     "--socket",     folder.path("robot"),
                                     "--trace",      folder.path("trace.csv"),
                                     "--seed",       "1"};
  std::vector<std::string> bridge{"saphira-bridge", "--link", "unix:" + folder.path("robot"),
                                  "--robot-file", robot_file};
  std::vector<std::string> intentions{"saphira-intentions"};
  if (scene.vision) {
    simulator.insert(simulator.end(), {"--stereo-socket", folder.path("eyes")});
    bridge.emplace_back("--vision");
    intentions.emplace_back("--vision");
  }
  run(simulator);
  on_bus(bridge);
  if (scene.vision)
    on_bus({"saphira-vision", "--stereo-socket", folder.path("eyes")});
  on_bus({"saphira-behaviors"});
  on_bus(intentions);
  on_bus({"saphira-interpretation"});
  on_bus({"saphira-registration", "--map", map});
}

v1::GoalId LockstepSystem::ask(const v1::Goal& goal) {
  const v1::GoalId id = goals.ask(goal);
  EXPECT_TRUE(wait_until([&] {
    node.wait(std::chrono::milliseconds(50));
    goals.poll();
    return goals.status(id).has_value();
  })) << output();
  return id;
}

void LockstepSystem::permit(std::uint64_t until) {
  permits_.write({.until_cycle = until});
}

std::optional<v1::GoalStatus> LockstepSystem::wait_end(const v1::GoalId& goal,
                                                       const std::function<void()>& meanwhile) {
  std::optional<v1::GoalStatus> status;
  wait_until(
      [&] {
        node.wait(std::chrono::milliseconds(50));
        goals.poll();
        meanwhile();
        status = goals.status(goal);
        return status && bus::ended(status->state);
      },
      std::chrono::minutes(4));
  return status;
}

std::string LockstepSystem::end() {
  processes_.front()->signal(SIGTERM);
  processes_.front()->wait();
  return read_file(folder.path("trace.csv"));
}

std::string LockstepSystem::output() const {
  std::string all;
  for (const auto& process : processes_)
    all += process->output() + "\n";
  return all;
}

void LockstepSystem::on_bus(std::vector<std::string> argv) {
  argv.insert(argv.end(), {"--robot", robot, "--domain", domain(), "--lockstep"});
  run(std::move(argv));
}

void LockstepSystem::run(std::vector<std::string> argv) {
  const std::string log = folder.path(argv.front() + ".log");
  processes_.push_back(std::make_unique<Process>(std::move(argv), log));
}

}  // namespace saphira::test
