#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/shell/processes.hpp"
#include "saphira/behaviors/executive.hpp"
#include "saphira/behaviors/folder.hpp"
#include "saphira/bus/cycle.hpp"
#include "saphira/bus/known_robot.hpp"

namespace saphira::behaviors {

struct ShellOptions {
  /// Behaviors that cover shipped ones of the same name; empty: none.
  std::string folder;
  std::vector<std::string> plugins;  ///< files, see plugin.hpp
};

/// The behaviors service on the bus. To be made and run in one thread.
class Shell {
 public:
  /// std::runtime_error where a plug-in, or the shipped behaviors, cannot be had at all.
  explicit Shell(bus::Node& node, const ShellOptions& options = {});

  /// Steps until stop is requested.
  void run(const bus::Stop& stop) {
    while (step(stop)) {
    }
  }
  /// Waits for one cycle and steps it; false when stop was requested.
  bool step(const bus::Stop& stop);

 private:
  void publish(const Output& output);
  /// Takes what the bridge says of how old the commands are when it obeys them.
  void take_delay();
  /// Takes behavior files that have changed.
  void look();

  bus::Node& node_;
  bus::Cycle cycle_;
  bus::Input<v1::Intentions>& intentions_;
  bus::KnownRobot robot_;
  std::optional<bus::Reader<v1::Grant>> grants_;  ///< none in lockstep: there is no delay
  PeakAge delay_;
  bus::Writer<v1::MotorCommand> commands_;
  bus::Writer<v1::Behaviors> behaviors_;
  bus::Writer<v1::Behaviors> recall_;
  ProcessTable table_;
  // sfInitControlProcs. Suspended it puts all behaviors away, and nobody drives.
  Process& execution_ =
      table_.add("execute-current-behaviors", "evaluates the behaviors, and drives the robot");
  ProcessesOnBus processes_;

  std::optional<std::uint64_t> odom_;  ///< of the newest step
  std::uint64_t odom_since_ = 0;       ///< cycle in which it last changed
  bus::Writer<v1::BehaviorSchemas> schemas_;
  Sources sources_;
  Executive executive_{Registry{}, RobotModel{}};
  std::uint64_t steps_ = 0;
  std::chrono::steady_clock::time_point looked_;  ///< when look() was last called
  std::uint64_t number_ = 0;                      ///< of the newest motor command
  std::string trouble_;
  bool slow_ = false;
  bool active_ = false;
};

}  // namespace saphira::behaviors
