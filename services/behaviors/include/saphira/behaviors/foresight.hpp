#pragma once

#include "saphira/behaviors/behavior.hpp"

namespace saphira::behaviors {

/// The robot's state when a command that is computed now takes effect, `seconds` after the state
/// that it answers: it goes on at its speed, and turns at its rate until it reaches its heading
/// setpoint.
RobotNow foresee(const RobotNow& robot, double seconds);

}  // namespace saphira::behaviors
