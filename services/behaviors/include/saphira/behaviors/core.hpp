#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "saphira/base/archived.hpp"
#include "saphira/base/notes.hpp"
#include "saphira/base/process.hpp"
#include "saphira/behaviors/executive.hpp"

namespace saphira::behaviors {

/// The behaviors service without the bus: one step a cycle, from inputs to outputs. All decisions
/// before the executive are made here.
class Core {
 public:
  struct Inputs {
    std::uint64_t cycle = 0;
    const RobotModel* new_robot = nullptr;  ///< the first step of an epoch
    bool new_frame = false;             ///< the odom frame has another origin since the last step
    const Registry* schemas = nullptr;  ///< all, where they have changed since the last step
    RobotNow robot;
    std::vector<lps::SonarReading> sonars;  ///< new ones, in firing order
    std::optional<Intent> intent;           ///< the newest, of any frame
    /// [s] The age of this service's command when the bridge used it, from the bridge's grant;
    /// nothing where the grant is for another driver.
    std::optional<double> command_age;
  };
  struct Outputs {
    Output output;
    std::uint64_t number = 0;  ///< of the motor command; counts up
    Notes notes;
    std::string degraded;  ///< the reason for restricted driving; empty: none
  };

  /// `schemas`: all, until others are an input.
  explicit Core(Registry schemas = {}) : executive_(std::move(schemas), RobotModel{}) {}

  Outputs step(const Inputs& inputs);

  ProcessTable& processes() { return processes_; }

  SAPHIRA_ARCHIVE(processes_, executive_, delay_, frame_since_, number_, trouble_, slow_, active_)

 private:
  void begin(const Inputs& inputs);
  void report(const Output& output, Outputs& outputs);

  ProcessTable processes_;
  // sfInitControlProcs. While suspended, it removes all behaviors, and releases the robot.
  Process& execution_ =
      processes_.add("execute-current-behaviors", "evaluates the behaviors, and drives the robot");
  Executive executive_;
  PeakAge delay_;
  std::uint64_t frame_since_ = 0;  ///< cycle in which the odom frame last changed
  std::uint64_t number_ = 0;
  std::string trouble_;
  bool slow_ = false;
  bool active_ = false;
};

}  // namespace saphira::behaviors
