#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/shell/processes.hpp"
#include "saphira/behaviors/executive.hpp"
#include "saphira/bus/cycle.hpp"
#include "saphira/bus/known_robot.hpp"

namespace saphira::behaviors {

/// The behaviors service on the bus. To be made and run in one thread.
class Shell {
 public:
  explicit Shell(bus::Node& node);

  /// Steps until stop is requested.
  void run(const bus::Stop& stop) {
    while (step(stop)) {
    }
  }
  /// Waits for one cycle and steps it; false when stop was requested.
  bool step(const bus::Stop& stop);

 private:
  void publish(const Output& output);

  bus::Node& node_;
  bus::Cycle cycle_;
  bus::Input<v1::Intentions>& intentions_;
  bus::KnownRobot robot_;
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
  Executive executive_{predefined(), RobotModel{}};
  std::uint64_t number_ = 0;  ///< of the newest motor command
  std::string trouble_;
  bool active_ = false;
};

}  // namespace saphira::behaviors
