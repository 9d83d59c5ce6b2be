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
/// The course of a move, by the grants of its robot. Pure.
class Course {
 public:
  enum class State {
    waits,  ///< its commands do not go to the wheels yet
    drives,
    done,  ///< sfDonePosition, sfDoneHeading: at the target, and at rest; never of a speed
    /// Over: a way or turn that the bridge has ended, a speed that did not go to the wheels for
    /// more than half a second. No robot drives off when a link comes back.
    interrupted
  };

  explicit Course(const Move& move) : move_(move) {}

  /// drives: this move's commands go to the wheels.
  State update(bool drives, const v1::Grant& grant, const v1::RobotState& robot);
  /// The remaining way [m or rad, not negative]; 0 of a speed.
  double left() const { return left_; }
  /// Such as ", 0.35 m left"; empty without a rest.
  std::string rest() const;

 private:
  Move move_;
  v1::Grant driving_;  ///< the newest by which it drove
  double left_ = 0.0;
  bool interrupted_ = false;
};

}  // namespace saphira::cli
