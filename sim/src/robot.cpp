#include "saphira/sim/robot.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/sim/scene.hpp"

namespace saphira::sim {

namespace {

// The heading servo's tolerance.
constexpr double kHeadingDeadband = 0.001;  // [rad]
constexpr double kWayDeadband = 0.0005;     // [m]

// A body elsewhere: from a command until its motion is measured, its servo's tolerance, and the
// noise of its speeds at rest.
constexpr double kLag = 0.3;                // [s]
constexpr double kBodyDeadband = 0.01;      // [rad]
constexpr double kBodyRest = 0.01;          // [m/s]
constexpr double kBodyRotationRest = 0.02;  // [rad/s]

// The grip of rubber on a floor: four tenths of its weight.
constexpr double kGrip = 4.0;  // [m/s2]

// The motors' short circuit.
constexpr double kEmergencyDeceleration = 6.0;  // [m/s2]

// The share of the wheels' way that the encoders still count while the robot is blocked.
constexpr double kPushSlip = 0.2;

constexpr int kPushes = 4;

// Nearer objects press a bumper.
constexpr double kBumperGap = 0.005;  // [m]

// A lead-acid battery's voltage falls nearly evenly by the first share until it is empty, and by
// the second while the motors run.
constexpr double kBatteryFall = 0.13;
constexpr double kBatterySag = 0.01;
// From full to empty at rest, and the factor with the motors running.
constexpr double kBatteryLife = 4.0 * 3600.0;  // [s]
constexpr double kMotorLoad = 2.5;

// The distance from its hull at which the robot considers obstacles.
constexpr double kLookout = 1.0;  // [m]

// A contact is over when the hull is this far away.
constexpr double kContactEnds = 0.005;  // [m]

// Settings of a client.
constexpr double kLeastAcceleration = 0.001;         // [m/s2]
constexpr double kLeastRotationAcceleration = 0.01;  // [rad/s2]

// The falling side of a trapezoid: the largest speed from which, after `lag` [s] more at it, the
// robot can still stop at the setpoint.
double falling_speed(double left, double deceleration, double lag = kTick) {
  return deceleration * (std::sqrt(lag * lag + 2.0 * left / deceleration) - lag);
}

// Approaches the target: away from zero by `up`, towards zero by `down`, and not through zero
// within one step.
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
      move_velocity_(max_velocity_),
      turn_velocity_(max_rotation_velocity_),
      acceleration_(parameters.acceleration),
      deceleration_(parameters.deceleration),
      rotation_acceleration_(parameters.rotation_acceleration),
      rotation_deceleration_(parameters.rotation_deceleration),
      max_acceleration_(std::max({parameters.max_acceleration, acceleration_, deceleration_})),
      max_rotation_acceleration_(std::max(
          {parameters.max_rotation_acceleration, rotation_acceleration_, rotation_deceleration_})),
      rotation_per_difference_(parameters.rotation_per_difference),
      max_wheel_velocity_(std::max(max_velocity_, wheel_share(max_rotation_velocity_))),
      encode_jitter_(parameters.encode_jitter),
      angle_jitter_(parameters.angle_jitter),
      drift_(parameters.angle_drift),
      random_(seed, 1),
      pose_in_world_(start_in_world),
      full_voltage_(parameters.battery) {
  if (random_.chance(0.5))
    drift_ = -drift_;
}

void Robot::set_velocity(double velocity) {
  translation_ = Translation::kVelocity;
  velocity_setpoint_ = std::clamp(velocity, -max_velocity_, max_velocity_);
}

void Robot::move_by(double way) {
  translation_ = Translation::kWay;
  way_setpoint_ = way_ + way;
  velocity_setpoint_ = 0.0;
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
  const Motion motion =
      possible({(left + right) / 2.0, (right - left) / 2.0 * rotation_per_difference_});
  set_velocity(motion.forward);
  set_rotation_velocity(motion.turn);
}

void Robot::set_origin() {
  heading_setpoint_ = norm2_angle(heading_setpoint_ - pose_in_odom_.th);
  pose_in_odom_ = {};
  if (body_)
    origin_ = body_->pose;
}

void Robot::stop() {
  set_velocity(0.0);
  set_rotation_velocity(0.0);
}

void Robot::emergency_stop() {
  stop();
  emergency_ = true;
}

void Robot::brake(bool on) {
  if (on && !braked_)
    set_rotation_velocity(0.0);
  braked_ = on;
}

void Robot::enable(bool on) {
  if (!on && enabled_)
    set_rotation_velocity(0.0);
  enabled_ = on;
}

void Robot::set_max_velocity(double velocity) {
  move_velocity_ = std::clamp(velocity, 0.001, max_velocity_);
}

void Robot::set_acceleration(double acceleration) {
  acceleration_ = std::clamp(acceleration, kLeastAcceleration, max_acceleration_);
}

void Robot::set_deceleration(double deceleration) {
  deceleration_ = std::clamp(deceleration, kLeastAcceleration, max_acceleration_);
}

void Robot::set_max_rotation_velocity(double velocity) {
  turn_velocity_ = std::clamp(velocity, 0.001, max_rotation_velocity_);
}

void Robot::set_rotation_acceleration(double acceleration) {
  rotation_acceleration_ =
      std::clamp(acceleration, kLeastRotationAcceleration, max_rotation_acceleration_);
}

void Robot::set_rotation_deceleration(double deceleration) {
  rotation_deceleration_ =
      std::clamp(deceleration, kLeastRotationAcceleration, max_rotation_acceleration_);
}

bool Robot::place(const Pose& pose_in_world) {
  if (scene_->distance(pose_in_world.position(), number_) < radius_)
    return false;
  pose_in_world_ = {pose_in_world.x, pose_in_world.y, norm2_angle(pose_in_world.th)};
  in_contact_ = false;
  free_way_ = 0.0;
  scene_->moved(number_);
  return true;
}

bool Robot::resume(const Memory& memory) {
  if (!place(memory.pose_in_world))
    return false;
  pose_in_odom_ = memory.pose_in_odom;
  charge_ = std::clamp(memory.charge, 0.0, 1.0);
  return true;
}

double Robot::wheel_share(double turn) const {
  return turn / rotation_per_difference_;
}

double Robot::left_velocity() const {
  return (body_ ? velocity() : wheel_velocity_) - wheel_share(rotation_velocity());
}

double Robot::right_velocity() const {
  return (body_ ? velocity() : wheel_velocity_) + wheel_share(rotation_velocity());
}

bool Robot::body_moves() const {
  return body_ && (std::abs(body_->velocity) > kBodyRest ||
                   std::abs(body_->rotation_velocity) > kBodyRotationRest);
}

void Robot::measure(const Measured& body) {
  body_ = body;
  pose_in_odom_ = relative(origin_, body.pose);
}

void Robot::halt() {
  stop();
  velocity_ = wheel_velocity_ = rotation_velocity_ = 0.0;
}

double Robot::target_velocity() const {
  if (!powered())
    return 0.0;
  return translation_ == Translation::kWay ? wanted_velocity() : velocity_setpoint_;
}

double Robot::target_heading() const {
  return rotation_ == Rotation::kHeading ? heading_setpoint_ : pose_in_odom_.th;
}

double Robot::target_rotation_velocity() const {
  return rotation_ == Rotation::kHeading || !powered() ? 0.0 : rotation_setpoint_;
}

double Robot::clearance() const {
  return scene_->distance(pose_in_world_.position(), number_) - radius_;
}

double Robot::wanted_velocity() const {
  const double left = way_setpoint_ - way_;
  const double size = std::abs(left);
  if (size < kWayDeadband)
    return 0.0;
  return std::copysign(std::min({falling_speed(size, deceleration_), move_velocity_, size / kTick}),
                       left);
}

double Robot::wanted_rotation_velocity() const {
  if (rotation_ == Rotation::kVelocity || !powered())
    return target_rotation_velocity();
  const double error = norm2_angle(heading_setpoint_ - pose_in_odom_.th);
  const double size = std::abs(error);
  if (size < (body_ ? kBodyDeadband : kHeadingDeadband))
    return 0.0;
  const double lag = body_ ? kLag : kTick;
  const double speed =
      std::min({falling_speed(size, rotation_deceleration_, lag), turn_velocity_, size / lag});
  return std::copysign(speed, error);
}

Robot::Motion Robot::possible(const Motion& wanted) const {
  const double forward = std::abs(wanted.forward);
  const double turn = std::abs(wanted.turn);
  double share = 1.0;
  const auto limit = [&share](double value, double most) {
    if (value > most)
      share = std::min(share, most / value);
  };
  limit(forward, max_velocity_);
  limit(turn, max_rotation_velocity_);
  limit(forward + wheel_share(turn), max_wheel_velocity_);
  return {wanted.forward * share, wanted.turn * share};
}

Robot::Motion Robot::next_motion() const {
  const double deceleration =
      emergency_ ? std::max(deceleration_, kEmergencyDeceleration) : deceleration_;
  Motion target{target_velocity(), wanted_rotation_velocity()};
  if (!controls_heading())
    target = possible(target);
  Motion next;
  next.turn = approach(rotation_velocity_, target.turn, rotation_acceleration_ * kTick,
                       rotation_deceleration_ * kTick);
  const double left = max_wheel_velocity_ - wheel_share(std::abs(next.turn));
  next.forward = approach(wheel_velocity_, std::clamp(target.forward, -left, left),
                          acceleration_ * kTick, deceleration * kTick);
  // Where the robot slows down more slowly than its turn speeds up, the turn waits.
  const double most = (max_wheel_velocity_ - std::abs(next.forward)) * rotation_per_difference_;
  next.turn = std::clamp(next.turn, -most, most);
  return next;
}

void Robot::tick() {
  const Motion next = next_motion();
  wheel_velocity_ = next.forward;
  rotation_velocity_ = next.turn;
  if (body_) {
    velocity_ = wheel_velocity_;
    emergency_ = emergency_ && moving();
    return;
  }
  const double pull = wheel_velocity_ - velocity_;
  velocity_ = std::abs(pull) <= kGrip * kTick ? wheel_velocity_
                                              : velocity_ + std::copysign(kGrip * kTick, pull);
  // The others may have come nearer.
  if (scene_->has_movable(number_))
    free_way_ -= scene_->fastest() * kTick;
  charge_ = std::max(0.0, charge_ - (moving() ? kMotorLoad : 1.0) * kTick / kBatteryLife);
  if (moving())
    move(velocity_ * kTick, rotation_velocity_ * kTick);
  else
    emergency_ = false;
}

// The obstacles that the robot might touch.
const Things& Robot::around() {
  const Vec2 at = pose_in_world_.position();
  around_.segments = near_.around(at);
  around_.discs.clear();
  scene_->add_movable(at, radius_ + kLookout, number_, around_);
  return around_;
}

// The share of a straight way before a contact; the way out of a contact is free.
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
  double slip = (wheel_velocity_ - velocity_) * kTick;
  const double middle = pose_in_world_.th + turn / 2.0;
  const Vec2 along(std::cos(middle), std::sin(middle));
  free_way_ -= std::abs(way);
  if (way != 0.0 && free_way_ <= 0.0) {
    const Vec2 at = pose_in_world_.position();
    double clearance_after = 0.0;
    double part = free_part(around(), way * along, clearance_after);
    // A box that turns under a push may need another push.
    bool pushed = false;
    for (int i = 0; i < kPushes && part < 1.0; ++i) {
      if (!scene_->push(number_, at + part * way * along, (1.0 - part) * way * along))
        break;
      pushed = true;
      part = free_part(around(), way * along, clearance_after);
    }
    if (pushed) {
      way *= part;
    } else if (part < 1.0) {
      const auto touched = nearest_point(around(), at);
      // A contact ahead stalls both motors, one at the side that side's (manual 6.3.1).
      const Vec2 offset = *touched - at;
      const double bearing =
          norm2_angle(std::atan2(offset.y(), offset.x()) - middle + (way < 0.0 ? kPi : 0.0));
      const double side = way < 0.0 ? -bearing : bearing;
      left_stalled_ |= side > radians(-30.0);
      right_stalled_ |= side < radians(30.0);
      if (!in_contact_)
        ++contacts_;
      in_contact_ = true;
      velocity_ = wheel_velocity_ = 0.0;
      slip += kPushSlip * (1.0 - part) * way;
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

  double measured_way = way + slip;
  double measured_turn = turn + drift_ * way;
  if (encode_jitter_ > 0.0 && way != 0.0)
    measured_way += random_.normal(0.0, encode_jitter_ * std::sqrt(std::abs(way)));
  if (angle_jitter_ > 0.0 && turn != 0.0)
    measured_turn += random_.normal(0.0, angle_jitter_ * std::sqrt(std::abs(turn)));
  way_ += measured_way;
  turned_ += measured_turn;
  const double measured_middle = pose_in_odom_.th + measured_turn / 2.0;
  pose_in_odom_.x += measured_way * std::cos(measured_middle);
  pose_in_odom_.y += measured_way * std::sin(measured_middle);
  pose_in_odom_.th = norm2_angle(pose_in_odom_.th + measured_turn);
}

std::uint8_t Robot::bumpers(int switches, bool rear) {
  switches = std::min(switches, 8);
  if (switches <= 0)
    return 0;
  const Vec2 at = pose_in_world_.position();
  const Things& things = around();
  std::uint8_t bits = 0;
  const auto touch = [&](const Vec2& point) {
    const Vec2 offset = point - at;
    if (offset.norm() > radius_ + kBumperGap)
      return;
    const double bearing =
        norm2_angle(std::atan2(offset.y(), offset.x()) - pose_in_world_.th + (rear ? kPi : 0.0));
    if (std::abs(bearing) > kPi / 2.0)
      return;
    // From the left: a rear bumper's left is at a negative bearing from the back.
    const double from_left = kPi / 2.0 - (rear ? -bearing : bearing);
    const int number = std::min(switches - 1, static_cast<int>(from_left / kPi * switches));
    bits = static_cast<std::uint8_t>(bits | (1U << static_cast<unsigned>(number)));
  };
  for (const Segment& segment : things.segments)
    touch(nearest_point(segment, at));
  for (const Disc& disc : things.discs)
    touch(disc.centre + (at - disc.centre).normalized() * disc.radius);
  return bits;
}

double Robot::battery() const {
  if (body_)
    return body_->battery;
  const double sag = moving() ? kBatterySag : 0.0;
  return full_voltage_ * (1.0 - kBatteryFall * (1.0 - charge_) - sag);
}

void Robot::set_battery(double voltage) {
  charge_ = full_voltage_ > 0.0
                ? std::clamp(1.0 - (1.0 - voltage / full_voltage_) / kBatteryFall, 0.0, 1.0)
                : 1.0;
}

}  // namespace saphira::sim
