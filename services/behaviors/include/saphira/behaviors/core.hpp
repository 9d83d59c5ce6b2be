#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "saphira/base/notes.hpp"
#include "saphira/base/process.hpp"
#include "saphira/behaviors/executive.hpp"

namespace saphira::behaviors {

/// The behaviors service without the bus: one step a cycle, from what came to what goes out.
/// Everything that is decided on the way to the executive is decided here.
class Core {
 public:
  struct Inputs {
    std::uint64_t cycle = 0;
    const RobotModel* new_robot = nullptr;  ///< the first step of an epoch
    bool new_frame = false;  ///< the odom frame has another origin since the last step
    RobotNow robot;
    std::vector<lps::SonarReading> sonars;  ///< new ones, in firing order
    std::optional<Intent> intent;           ///< the newest, of whatever frame
    /// [s] How old the commands of this service were when the bridge obeyed one, as it says;
    /// nothing where it says nothing of them.
    std::optional<double> command_age;
  };
  struct Outputs {
    Output output;
    std::uint64_t number = 0;  ///< of the motor command; counts up
    Notes notes;
    std::string degraded;  ///< why the robot does not drive as it should; empty: it does
  };

  Outputs step(const Inputs& inputs);

  Registry& registry() { return executive_.registry(); }
  ProcessTable& processes() { return processes_; }

 private:
  void begin(const Inputs& inputs);
  void tell(const Output& output, Outputs& outputs);

  ProcessTable processes_;
  // sfInitControlProcs. Suspended it puts all behaviors away, and nobody drives.
  Process& execution_ =
      processes_.add("execute-current-behaviors", "evaluates the behaviors, and drives the robot");
  Executive executive_{Registry{}, RobotModel{}};
  PeakAge delay_;
  std::uint64_t frame_since_ = 0;  ///< cycle in which the odom frame last changed
  std::uint64_t number_ = 0;
  std::string trouble_;
  bool slow_ = false;
  bool active_ = false;
};

}  // namespace saphira::behaviors
