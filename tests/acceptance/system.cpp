#include "system.hpp"

#include <cmath>
#include <filesystem>

#include "saphira/base/text.hpp"

namespace saphira::test {

namespace {

bool stands(const sim::TraceRow& row) {
  return std::abs(row.velocity) < 0.005 && std::abs(row.rotation_velocity) < 0.01;
}

}  // namespace

void System::start(const std::string& name) {
  std::vector<std::string> argv{name};
  const auto add = [&](const std::vector<std::string>& words) {
    argv.insert(argv.end(), words.begin(), words.end());
  };
  if (name == "saphira-sim")
    add({"--world", source("config/worlds/office.wld"), "--robot",
         source("config/robots/pioneer.p"), "--socket", simulator_socket(), "--trace",
         folder_.path("trace.csv"), "--seed", "1"});
  else
    add({"--robot", robot_, "--domain", domain()});
  if (name == "saphira-bridge")
    add({"--robot-port", "unix:" + simulator_socket(), "--robots", source("config/robots"),
         "--state", folder_.path("bridge.state")});
  if (name == "saphira-intentions")
    add({"--memory", folder_.path("goals")});
  if (name == "saphira-registration")
    add({"--map", source("config/maps/office.map"), "--map-memory", folder_.path("map.memory")});
  processes_.erase(name);
  processes_[name] = std::make_unique<Process>(argv, folder_.path(name + ".log"));
}

void System::start_all() {
  for (const char* name : {"saphira-sim", "saphira-bridge", "saphira-behaviors",
                           "saphira-intentions", "saphira-interpretation", "saphira-registration"})
    start(name);
}

v1::GoalId System::go_to(double x, double y) {
  return goals_.ask(goal("go_to", {bus::point("position", x, y, 0.0, v1::FRAME_ODOM)}));
}

std::optional<v1::GoalStatus> System::wait_end(const v1::GoalId& goal,
                                               const std::function<void()>& meanwhile) {
  std::optional<v1::GoalStatus> status;
  const bool ended = wait_until(
      [&] {
        meanwhile();
        goals_.poll();
        status = goals_.status(goal);
        return status && bus::ended(status->state);
      },
      std::chrono::minutes(2));
  return ended ? status : std::nullopt;
}

std::vector<sim::TraceRow> System::trace() const {
  const std::string file = folder_.path("trace.csv");
  return std::filesystem::exists(file) ? sim::parse_trace(read_file(file), file)
                                       : std::vector<sim::TraceRow>();
}

sim::TraceRow System::truth() const {
  const std::vector<sim::TraceRow> rows = trace();
  return rows.empty() ? sim::TraceRow{} : rows.back();
}

bool System::still() const {
  return stands(truth());
}

std::optional<std::uint64_t> System::stood_still(std::uint64_t cycle) const {
  for (const sim::TraceRow& row : trace())
    if (row.cycle >= cycle && stands(row))
      return row.cycle;
  return std::nullopt;
}

bool System::wait_moving(std::chrono::milliseconds limit) {
  return wait_until([this] { return truth().velocity > 0.15; }, limit);
}

bool System::wait_still(std::chrono::milliseconds limit) {
  return wait_until([this] { return still(); }, limit);
}

std::string System::output() const {
  std::string all;
  for (const auto& [name, process] : processes_)
    all += "--- " + name + "\n" + process->output();
  return all;
}

}  // namespace saphira::test
