#pragma once

#include "saphira/behaviors/behavior.hpp"

namespace saphira::behaviors {

/// Where the robot will be when a command that is computed now comes to work, `seconds` after the
/// state that it answers: on at its speed, and turning at its rate until it points where it was
/// told to.
RobotNow foresee(const RobotNow& robot, double seconds);

}  // namespace saphira::behaviors
