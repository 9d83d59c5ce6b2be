#include "saphira/sim/robot.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/sim/scene.hpp"

namespace saphira::sim {

namespace {

// The heading servo is content within this.
constexpr double kHeadingDeadband = 0.001;  // [rad]

// How far from its hull the robot looks for what it might touch.
constexpr double kLookout = 1.0;  // [m]

// A contact is over when the hull is this far away.
constexpr double kContactEnds = 0.005;  // [m]

// Towards the target: away from zero by `up`, towards zero by `down`, and not through zero within
// one step.
double approach(double value, double target, double up, double down) {
  if (value > 0.0 && target < value)
    return std::max({value - down, target, 0.0});
  if (value < 0.0 && target > value)
    return std::min({value + down, target, 0.0});
  if (target > value)
    return std::min(value + up, target);
  return std::max(value - up, target);
}

}  // namespace

Robot::Robot(Scene& scene, std::size_t number, const protocol::RobotParameters& parameters,
             const Pose& start_in_world, std::uint64_t seed)
    : scene_(&scene),
      number_(number),
      near_(scene.world(), parameters.radius + kLookout),
      radius_(parameters.radius),
      max_velocity_(parameters.max_velocity),
      max_rotation_velocity_(parameters.max_rotation_velocity),
      acceleration_(parameters.acceleration),
      deceleration_(parameters.deceleration),
      rotation_acceleration_(parameters.rotation_acceleration),
      rotation_deceleration_(parameters.rotation_deceleration),
      rotation_per_difference_(parameters.rotation_per_difference),
      encode_jitter_(parameters.encode_jitter),
      angle_jitter_(parameters.angle_jitter),
      drift_(parameters.angle_drift),
      random_(seed, 1),
      pose_in_world_(start_in_world) {
  if (random_.chance(0.5))
    drift_ = -drift_;
}

void Robot::set_velocity(double velocity) {
  velocity_setpoint_ = std::clamp(velocity, -max_velocity_, max_velocity_);
}

void Robot::set_heading(double heading_in_odom) {
  rotation_ = Rotation::kHeading;
  heading_setpoint_ = norm2_angle(heading_in_odom);
}

void Robot::turn_by(double angle) {
  set_heading(pose_in_odom_.th + angle);
}

void Robot::set_rotation_velocity(double velocity) {
  rotation_ = Rotation::kVelocity;
  rotation_setpoint_ = std::clamp(velocity, -max_rotation_velocity_, max_rotation_velocity_);
}

void Robot::set_wheel_velocities(double left, double right) {
  set_velocity((left + right) / 2.0);
  set_rotation_velocity((right - left) / 2.0 * rotation_per_difference_);
}

void Robot::set_origin() {
  heading_setpoint_ = norm2_angle(heading_setpoint_ - pose_in_odom_.th);
  pose_in_odom_ = {};
}

void Robot::stop() {
  set_velocity(0.0);
  set_rotation_velocity(0.0);
}

void Robot::brake(bool on) {
  if (on && !braked_)
    set_rotation_velocity(0.0);
  braked_ = on;
}

double Robot::left_velocity() const {
  return velocity_ - rotation_velocity_ / rotation_per_difference_;
}

double Robot::right_velocity() const {
  return velocity_ + rotation_velocity_ / rotation_per_difference_;
}

double Robot::target_velocity() const {
  return braked_ ? 0.0 : velocity_setpoint_;
}

double Robot::target_heading() const {
  return rotation_ == Rotation::kHeading ? heading_setpoint_ : pose_in_odom_.th;
}

double Robot::target_rotation_velocity() const {
  return rotation_ == Rotation::kHeading || braked_ ? 0.0 : rotation_setpoint_;
}

double Robot::clearance() const {
  return scene_->distance(pose_in_world_.position(), number_) - radius_;
}

double Robot::wanted_rotation_velocity() const {
  if (rotation_ == Rotation::kVelocity)
    return target_rotation_velocity();
  const double error = norm2_angle(heading_setpoint_ - pose_in_odom_.th);
  const double size = std::abs(error);
  if (size < kHeadingDeadband)
    return 0.0;
  // The falling side of the trapezoid: the largest speed from which the robot, after one more tick
  // at it, can still stop at the setpoint.
  const double a = rotation_deceleration_;
  const double falling = a * (std::sqrt(kTick * kTick + 2.0 * size / a) - kTick);
  const double speed = std::min({falling, max_rotation_velocity_, size / kTick});
  return std::copysign(speed, error);
}

void Robot::tick() {
  velocity_ = approach(velocity_, target_velocity(), acceleration_ * kTick, deceleration_ * kTick);
  rotation_velocity_ = approach(rotation_velocity_, wanted_rotation_velocity(),
                                rotation_acceleration_ * kTick, rotation_deceleration_ * kTick);
  // The others may have come nearer.
  if (scene_->has_movable(number_))
    free_way_ -= scene_->fastest() * kTick;
  if (moving())
    move(velocity_ * kTick, rotation_velocity_ * kTick);
}

// What the robot might touch.
const Things& Robot::around() {
  const Vec2 at = pose_in_world_.position();
  around_.segments = near_.around(at);
  around_.discs.clear();
  scene_->add_movable(at, radius_ + kLookout, number_, around_);
  return around_;
}

// The part of a straight way that the robot can go before it touches; moving off from where it
// touches is free.
double Robot::free_part(const Things& things, const Vec2& way, double& clearance_after) {
  const Vec2 at = pose_in_world_.position();
  const double now = distance(things, at) - radius_;
  const double limit = std::min(0.0, now);
  clearance_after = distance(things, at + way) - radius_;
  if (clearance_after >= limit)
    return 1.0;
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 30; ++i) {
    const double middle = (low + high) / 2.0;
    (distance(things, at + middle * way) - radius_ >= limit ? low : high) = middle;
  }
  clearance_after = distance(things, at + low * way) - radius_;
  return low;
}

void Robot::move(double way, double turn) {
  const double middle = pose_in_world_.th + turn / 2.0;
  const Vec2 along(std::cos(middle), std::sin(middle));
  free_way_ -= std::abs(way);
  if (way != 0.0 && free_way_ <= 0.0) {
    const Things& things = around();
    double clearance_after = 0.0;
    const double part = free_part(things, way * along, clearance_after);
    if (part < 1.0) {
      const auto touched = nearest_point(things, pose_in_world_.position());
      // A contact ahead stalls both motors, one at the side that side's (manual 6.3.1).
      const Vec2 offset = *touched - pose_in_world_.position();
      const double bearing =
          norm2_angle(std::atan2(offset.y(), offset.x()) - middle + (way < 0.0 ? kPi : 0.0));
      const double side = way < 0.0 ? -bearing : bearing;
      left_stalled_ |= side > radians(-30.0);
      right_stalled_ |= side < radians(30.0);
      if (!in_contact_)
        ++contacts_;
      in_contact_ = true;
      velocity_ = 0.0;
      way *= part;
    } else if (clearance_after > kContactEnds) {
      in_contact_ = false;
    }
    free_way_ = std::max(0.0, std::min(clearance_after, 1.0) - kContactEnds);
  }
  pose_in_world_.x += way * along.x();
  pose_in_world_.y += way * along.y();
  pose_in_world_.th = norm2_angle(pose_in_world_.th + turn);
  scene_->moved(number_);

  double measured_way = way;
  double measured_turn = turn + drift_ * way;
  if (encode_jitter_ > 0.0 && way != 0.0)
    measured_way += random_.normal(0.0, encode_jitter_ * std::sqrt(std::abs(way)));
  if (angle_jitter_ > 0.0 && turn != 0.0)
    measured_turn += random_.normal(0.0, angle_jitter_ * std::sqrt(std::abs(turn)));
  const double measured_middle = pose_in_odom_.th + measured_turn / 2.0;
  pose_in_odom_.x += measured_way * std::cos(measured_middle);
  pose_in_odom_.y += measured_way * std::sin(measured_middle);
  pose_in_odom_.th = norm2_angle(pose_in_odom_.th + measured_turn);
}

}  // namespace saphira::sim
