#include "scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "node_options.hpp"
#include "saphira/base/text.hpp"

namespace saphira::test {

using std::chrono::milliseconds;

Scene::Scene(bool lockstep)
    : node(node_options("test", robot, lockstep)),
      lockstep_(lockstep),
      states_(node.reader(bus::topics::kRobotState)),
      descriptions_(node.reader(bus::topics::kRobotDescription)),
      grants_(node.reader(bus::topics::kGrant)),
      statuses_(node.reader(bus::topics::kStatus)),
      devices_(node.reader(bus::topics::kDevices)),
      permits_(node.writer(bus::topics::kStepPermit)) {
  robot_port = folder.path("robot");
  use(lockstep ? bus::topics::kDriveBehaviors : bus::topics::kDriveDirect);
  command.source = "test";
  command.active = true;
}

void Scene::use(const bus::Topic<v1::MotorCommand>& role) {
  driver_.emplace(node.writer(role));
}

void Scene::start_simulator() {
  std::ofstream(folder.path("test.wld")) << world;
  std::vector<std::string> argv{"saphira-sim",
                                "--world",
                                folder.path("test.wld"),
                                "--robot",
                                std::filesystem::path(source("config/robots")) / robot_file,
                                "--socket",
                                folder.path("robot"),
                                "--trace",
                                folder.path("trace.csv")};
  if (lockstep_)
    argv.emplace_back("--step");
  simulator.reset();
  simulator = std::make_unique<Process>(argv, folder.path("sim.log"));
}

void Scene::start_bridge() {
  std::vector<std::string> argv{"saphira-bridge", "--robot",  robot,
                                "--domain",       domain(),   "--robot-port",
                                robot_port,       "--robots", source("config/robots")};
  if (lockstep_)
    argv.emplace_back("--lockstep");
  argv.insert(argv.end(), bridge_options.begin(), bridge_options.end());
  bridge.reset();
  bridge =
      std::make_unique<Process>(argv, folder.path("bridge" + std::to_string(++runs_) + ".log"));
}

void Scene::publish() {
  command.number = command.number + 1;
  if (follows_cycles)
    command.stamp = state.stamp;
  else
    command.stamp = v1::Stamp();
  driver_->write(command);
  published_ = std::chrono::steady_clock::now();
}

void Scene::permit(std::uint64_t last) {
  // A command before the bridge is discovered reaches nobody, and each is sent once.
  EXPECT_TRUE(until([this] { return driver_->matched() > 0; }));
  permits_.write({.source = "test", .until_cycle = last});
}

void Scene::take() {
  for (const auto& sample : states_.take()) {
    state = sample.data;
    states.push_back(state);
  }
  for (const auto& sample : descriptions_.take()) {
    if (!sample.info.disposed)
      description = sample.data;
  }
  for (const auto& sample : grants_.take()) {
    grant = sample.data;
    grants.push_back(grant);
  }
  if (const auto newest = devices_.take_newest())
    devices = *newest;
  for (const auto& sample : statuses_.take()) {
    if (!sample.info.disposed && sample.data.name == "bridge")
      status = sample.data;
  }
}

bool Scene::until(const std::function<bool()>& condition, milliseconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (true) {
    take();
    if (condition())
      return true;
    const auto now = std::chrono::steady_clock::now();
    if (now >= end)
      return false;
    if (lockstep_ ? state.stamp.cycle != command.stamp.cycle
                  : drives && now - published_ >= milliseconds(50))
      publish();
    node.wait(milliseconds(10));
  }
}

void Scene::watch(milliseconds time) {
  until([] { return false; }, time);
}

v1::Answer Scene::ask(const bus::RequestTopic& topic, const std::string& functor,
                      const std::vector<v1::Argument>& arguments) {
  return bus::RequestClient(node, topic, "test")
      .ask(bus::request(functor, arguments), 30.0, nullptr, [this] {
        take();
        if (drives)
          publish();
      });
}

bool Scene::rests() const {
  return std::abs(state.velocity) < 0.01 && std::abs(state.rotation_velocity) < 0.05;
}

std::vector<sim::TraceRow> Scene::whole_trace() const {
  return sim::parse_trace(read_file(folder.path("trace.csv")), "trace.csv");
}

std::vector<sim::TraceRow> Scene::trace() const {
  std::vector<sim::TraceRow> rows = whole_trace();
  std::size_t begin = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].first)
      begin = i;
  }
  rows.erase(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(begin));
  return rows;
}

std::vector<sim::TraceRow> Scene::end() {
  simulator->signal(SIGTERM);
  simulator->wait();
  return trace();
}

void forward(v1::MotorCommand& command, double velocity, double rotation) {
  command.active = true;
  command.translation = v1::TRANSLATION_VELOCITY;
  command.velocity = velocity;
  command.rotation = v1::ROTATION_VELOCITY;
  command.rotation_velocity = rotation;
}

std::uint64_t stood_still(const std::vector<sim::TraceRow>& rows, std::uint64_t cycle) {
  for (const sim::TraceRow& row : rows) {
    if (row.cycle >= cycle && std::abs(row.velocity) < 1e-3 &&
        std::abs(row.rotation_velocity) < 1e-2)
      return row.cycle;
  }
  return 0;
}

}  // namespace saphira::test
