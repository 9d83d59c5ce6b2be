#pragma once

#include <string>

#include "saphira/idl/motion.hpp"
#include "saphira/idl/robot.hpp"

namespace saphira::cli {

/// One direct motion (manual 6.4).
struct Move {
  enum class Kind {
    move,  ///< a distance along the heading (sfSetPosition)
    turn,  ///< by an angle (sfSetDHeading)
    speed  ///< sfSetVelocity
  };
  Kind kind = Kind::speed;
  std::string name;    ///< of the command
  double value = 0.0;  ///< [m], [rad], [m/s]
  double speed = 0.0;  ///< [m/s] of a move, at most [0: the robot's own]
};

/// The least change of a way or angle that counts as progress [m or rad].
inline constexpr double kProgress = 0.01;

/// The error in the motion, in words; empty: none.
std::string trouble_of(const Move& move);
/// The command to repeat until it is done.
v1::MotorCommand command_of(const Move& move);
/// The remaining way [m or rad, not negative], by the grant; 0 for a speed.
double left_of(const Move& move, const v1::Grant& grant, const v1::RobotState& robot);
/// sfDonePosition, sfDoneHeading: at the target, and at rest. A speed is never done.
bool done(const Move& move, const v1::Grant& grant, const v1::RobotState& robot);
/// Such as ", 0.35 m left"; empty without a rest.
std::string rest_of(const Move& move, const v1::Grant& grant, const v1::RobotState& robot);

}  // namespace saphira::cli
