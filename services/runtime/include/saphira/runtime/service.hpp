#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "saphira/base/process.hpp"
#include "saphira/idl/common.hpp"
#include "saphira/runtime/ports.hpp"

namespace saphira::runtime {

/// The present step, for every service.
struct Turn {
  v1::Stamp stamp;
  const v1::RobotState& robot;
  const v1::RobotDescription& description;
  bool new_robot = false;  ///< the first step of an epoch: another connection, maybe another robot
  bool new_frame = false;  ///< the odom frame has another origin than in the step before
};

/// A service on the bus: a core behind its ports. It converts, and decides nothing; its constructor
/// takes inputs and outputs from Ports. The shell does everything else.
class Service {
 public:
  virtual ~Service() = default;

  /// The core's micro-tasks.
  virtual ProcessTable& processes() = 0;
  /// Handles interrupt and resume for a name that is no process's: empty where done, the reason
  /// where not; nothing for an unknown name.
  virtual std::optional<std::string> ask(const std::string& /*name*/, ProcessAction /*action*/,
                                         std::uint32_t /*cycles*/) {
    return std::nullopt;
  }

  /// One cycle: inputs, the core's step, outputs. The output that moves the robot is written first.
  virtual void step(const Turn& turn) = 0;
  /// Takes inputs that need no cycle, and publishes the changes by requests; `silence` [s] since
  /// the newest step.
  virtual void between(double /*silence*/) {}
  /// Checks the files that people edit while the robot drives. Called once a second, after a step;
  /// in lockstep, where cycles are short, every hundred.
  virtual void look() {}
};

}  // namespace saphira::runtime
