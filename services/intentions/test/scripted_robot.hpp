#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "saphira/intentions/executor.hpp"

namespace saphira::intentions {

/// A robot and a behaviors service in one, in the simplest form: it obeys the strongest intended
/// behavior at once. One cycle late, as on the bus.
class ScriptedRobot {
 public:
  Robot robot{.connected = true, .odom = 1};
  std::vector<BehaviorLevel> levels;
  bool held = false;  ///< blocked: it does not move

  /// The world moves from the cycle of `outputs` to the next.
  void move(const std::vector<IntendedBehavior>& behaviors) {
    levels.clear();
    double velocity = 0.0;
    double turn = 0.0;
    for (const IntendedBehavior& behavior : behaviors) {
      double goal = 0.0;
      if (behavior.schema == "GoToPos") {
        const Pose there = relative(robot.pose_in_odom, find(behavior.parameters, "goal")->point);
        const double left = there.position().norm();
        goal = left <= find(behavior.parameters, "radius")->number ? 1.0 : 0.0;
        if (goal < 1.0) {
          turn = std::atan2(there.y, there.x);
          velocity = std::min(find(behavior.parameters, "speed")->number, left / kTick);
        }
      } else if (behavior.schema == "TurnTo") {
        const Pose there = relative(robot.pose_in_odom, find(behavior.parameters, "goal")->point);
        turn = std::clamp(std::atan2(there.y, there.x), -0.2, 0.2);
        goal = std::abs(turn) <= find(behavior.parameters, "success_angle")->number ? 1.0 : 0.0;
      } else if (behavior.schema == "ConstantVelocity") {
        velocity = find(behavior.parameters, "speed")->number;
      }
      levels.push_back({behavior.name, goal, 0.0});
    }
    if (held) {
      velocity = 0.0;
      turn = 0.0;
    }
    robot.velocity = velocity;
    robot.rotation_velocity = turn / kTick;
    robot.pose_in_odom = compose(robot.pose_in_odom, {0.0, 0.0, turn});
    robot.pose_in_odom = compose(robot.pose_in_odom, {velocity * kTick, 0.0, 0.0});
  }
};

}  // namespace saphira::intentions
