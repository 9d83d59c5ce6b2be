#include "saphira/ros2/inward.hpp"

#include <cmath>
#include <map>

#include "saphira/geometry/pose.hpp"
#include "saphira/ros2/outward.hpp"

namespace saphira::ros2 {

namespace {

constexpr int kReleases = 4;  // repetitions: the topic is best effort

}  // namespace

bool Wheels::heard(const Twist& twist, double now) {
  if (!std::isfinite(twist.linear.x) || !std::isfinite(twist.angular.z))
    return false;
  const bool rests = twist.linear.x == 0.0 && twist.angular.z == 0.0;
  if (rests || !newest_)
    stopped_ = false;
  newest_ = twist;
  came_ = now;
  return true;
}

void Wheels::heard(const v1::Grant& grant) {
  if (!stops_.hear(grant).empty() && newest_)
    stopped_ = true;
}

std::optional<v1::MotorCommand> Wheels::next(double now) {
  if (newest_ && now - came_ > kPatience) {
    newest_.reset();
    stopped_ = false;
  }
  v1::MotorCommand command;
  if (newest_ && !stopped_) {
    releases_left_ = kReleases;
    command.active = true;
    command.translation = v1::TRANSLATION_VELOCITY;
    command.velocity = newest_->linear.x;
    command.rotation = v1::ROTATION_VELOCITY;
    command.rotation_velocity = newest_->angular.z;
    return command;
  }
  if (releases_left_ == 0)
    return std::nullopt;
  --releases_left_;
  return command;
}

std::optional<v1::Argument> argument_of(const std::string& name, const Header& header,
                                        const Pose3& pose) {
  static const std::map<std::string, v1::Frame> frames{
      {"map", v1::FRAME_MAP}, {"odom", v1::FRAME_ODOM}, {"base_link", v1::FRAME_ROBOT}};
  const auto frame = frames.find(header.frame_id);
  const Quaternion& turn = pose.orientation;
  const v1::Pose2 point{pose.position.x, pose.position.y,
                        std::atan2(2 * (turn.w * turn.z + turn.x * turn.y),
                                   1 - 2 * (turn.y * turn.y + turn.z * turn.z))};
  if (frame == frames.end() || !std::isfinite(point.x) || !std::isfinite(point.y) ||
      !std::isfinite(point.th))
    return std::nullopt;
  return v1::Argument{
      .name = name, .kind = v1::ARGUMENT_POINT, .point = point, .frame = frame->second};
}

PoseStamped in_odom(const PoseStamped& pose, const v1::Pose2& robot_in_odom) {
  const std::optional<v1::Argument> read = argument_of("", pose.header, pose.pose);
  if (!read || read->frame != v1::FRAME_ROBOT)
    return pose;
  const Pose placed = compose({robot_in_odom.x, robot_in_odom.y, robot_in_odom.th},
                              {read->point.x, read->point.y, read->point.th});
  return {{pose.header.stamp, "odom"}, pose_of({placed.x, placed.y, placed.th})};
}

std::optional<v1::Goal> goal_of(const PoseStamped& pose) {
  const std::optional<v1::Argument> position = argument_of("position", pose.header, pose.pose);
  if (!position)
    return std::nullopt;
  v1::Goal goal{.functor = "go_to"};
  goal.arguments.push_back(*position);
  if (position->frame != v1::FRAME_ROBOT) {
    v1::Argument facing;
    facing.name = "facing";
    facing.kind = v1::ARGUMENT_NUMBER;
    facing.number = position->point.th;
    goal.arguments.push_back(facing);
  }
  return goal;
}

}  // namespace saphira::ros2
