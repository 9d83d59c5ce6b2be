#pragma once

#include <optional>
#include <string>

#include "saphira/bus/stop_notice.hpp"
#include "saphira/idl/intention.hpp"
#include "saphira/ros2/messages.hpp"

namespace saphira::ros2 {

/// cmd_vel as driving: while messages come, and a moment longer. Times are seconds of any clock
/// that does not jump.
class Wheels {
 public:
  /// [s] after the newest message until the robot is let go.
  static constexpr double kPatience = 0.5;

  /// False where its numbers cannot be: as if it had not come.
  bool heard(const Twist& twist, double now);
  /// Takes a grant. After a stop it begins anew: with a message of no motion, or after a silence.
  void heard(const v1::Grant& grant);

  /// The command to send now, ten times a second or more; none: there is nothing to say.
  std::optional<v1::MotorCommand> next(double now);

 private:
  std::optional<Twist> newest_;
  double came_ = 0.0;
  bool stopped_ = false;
  int releases_left_ = 0;
  bus::StopNotice stops_;
};

/// A pose as an argument. Nothing: its frame is not map, odom or base_link, or its numbers cannot
/// be.
std::optional<v1::Argument> argument_of(const std::string& name, const Header& header,
                                        const Pose3& pose);
/// The same pose in odom, where it is one of base_link.
PoseStamped in_odom(const PoseStamped& pose, const v1::Pose2& robot_in_odom);
/// A goal to drive there, and to face as the pose does unless it is in base_link.
std::optional<v1::Goal> goal_of(const PoseStamped& pose);

}  // namespace saphira::ros2
