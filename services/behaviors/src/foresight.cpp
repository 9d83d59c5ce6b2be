#include "saphira/behaviors/foresight.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::behaviors {

RobotNow foresee(const RobotNow& robot, double seconds) {
  const double left = norm2_angle(robot.target_heading_in_odom - robot.pose_in_odom.th);
  const double turn =
      std::clamp(robot.rotation_velocity * seconds, std::min(left, 0.0), std::max(left, 0.0));
  const double way = robot.velocity * seconds;
  const double course = robot.pose_in_odom.th + turn / 2.0;
  RobotNow ahead = robot;
  ahead.pose_in_odom = {robot.pose_in_odom.x + way * std::cos(course),
                        robot.pose_in_odom.y + way * std::sin(course),
                        norm2_angle(robot.pose_in_odom.th + turn)};
  return ahead;
}

}  // namespace saphira::behaviors
