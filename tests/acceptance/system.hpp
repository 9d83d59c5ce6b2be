#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "goals.hpp"
#include "node_options.hpp"
#include "process.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/sim/trace.hpp"

namespace saphira::test {

/// A robot with its services as separate processes, live, in its own partition and folder, and a
/// node of the test beside them.
class System {
 public:
  /// Starts, or restarts, one of saphira-sim, saphira-bridge, saphira-behaviors,
  /// saphira-intentions.
  void start(const std::string& name);
  void start_all();
  Process& operator[](const std::string& name) { return *processes_.at(name); }

  const std::string& robot() const { return robot_; }
  const TempDir& folder() const { return folder_; }
  bus::Node& node() { return node_; }
  bus::GoalClient& goals() { return goals_; }
  /// Asks the robot to go to a place [m] in odom.
  v1::GoalId go_to(double x, double y);

  /// Waits for the goal's end, and calls `meanwhile` until then; nothing without an end.
  std::optional<v1::GoalStatus> wait_end(
      const v1::GoalId& goal, const std::function<void()>& meanwhile = [] {});

  /// The newest line of the trace.
  sim::TraceRow truth() const;
  /// Below visible motion; the servo's last tremble does not count.
  bool still() const;
  /// The first cycle from that one on with a standing robot, as far as the trace goes.
  std::optional<std::uint64_t> stood_still(std::uint64_t cycle) const;
  /// Waits until the trace shows motion.
  bool wait_moving(std::chrono::milliseconds limit = std::chrono::seconds(30));
  bool wait_still(std::chrono::milliseconds limit = std::chrono::seconds(30));
  /// Everything that the processes have printed.
  std::string output() const;

 private:
  std::string simulator_socket() const { return folder_.path("robot"); }
  std::vector<sim::TraceRow> trace() const;

  TempDir folder_;
  std::string robot_ = unique_robot();
  bus::Node node_{node_options("test", robot_)};
  bus::GoalClient goals_{node_, "test"};
  std::map<std::string, std::unique_ptr<Process>> processes_;
};

}  // namespace saphira::test
