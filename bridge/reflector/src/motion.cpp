#include "saphira/reflector/motion.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::reflector {

namespace {

constexpr std::size_t kMaxDrivers = 256;
// The manual's Pioneer cannot be placed better than about 0.1 m (6.4); this only ends the creeping.
constexpr double kThere = 0.005;    // [m]
constexpr double kCreep = 0.03;     // [m/s] the least speed that moves a robot
constexpr double kReaction = 0.15;  // [s] from a packet to the effect of its answer

}  // namespace

void DirectMotion::stop() {
  setpoints_ = {};
  target_.reset();
}

void DirectMotion::set(const Motion& motion, const Pose& pose_in_odom) {
  bool begins = false;
  if (motion.translation == Translation::position ||
      motion.rotation == Rotation::relative_heading) {
    if (begun_.size() >= kMaxDrivers && !begun_.contains(motion.driver))
      begun_.erase(std::min_element(begun_.begin(), begun_.end(), [](auto& a, auto& b) {
        return a.second.used < b.second.used;
      }));
    const auto [begun, fresh] = begun_.try_emplace(motion.driver);
    begins = fresh || begun->second.move != motion.move;
    begun->second = {motion.move, ++sets_};
  }
  switch (motion.translation) {
    case Translation::none:
      break;
    case Translation::velocity:
      target_.reset();
      setpoints_.velocity = motion.velocity;
      break;
    case Translation::position:
      if (begins)
        target_ = travelled_ + motion.distance;
      else if (!target_)  // it is over: a velocity came in between
        setpoints_.velocity = 0.0;
      speed_ = std::abs(motion.velocity) > 0.0 ? std::abs(motion.velocity) : limits_.max_velocity;
      break;
  }
  switch (motion.rotation) {
    case Rotation::none:
      break;
    case Rotation::velocity:
      setpoints_.turn_to_heading = false;
      setpoints_.rotation_velocity = motion.rotation_velocity;
      break;
    case Rotation::heading:
      setpoints_.turn_to_heading = true;
      setpoints_.heading_in_odom = norm2_angle(motion.heading);
      break;
    case Rotation::relative_heading:
      if (begins) {
        setpoints_.turn_to_heading = true;
        setpoints_.heading_in_odom = norm2_angle(pose_in_odom.th + motion.heading);
      } else if (!setpoints_.turn_to_heading) {
        setpoints_.rotation_velocity = 0.0;
      }
      break;
  }
}

Setpoints DirectMotion::setpoints() const {
  Setpoints out = setpoints_;
  if (target_) {
    const double left = distance_left();
    const double a = limits_.deceleration;
    // v t + v^2 / 2a = left: the speed from which the robot still stops at the target.
    const double v = a * (std::sqrt(kReaction * kReaction + 2.0 * std::abs(left) / a) - kReaction);
    out.velocity = left == 0.0 ? 0.0 : std::copysign(std::min(speed_, std::max(kCreep, v)), left);
  }
  return out;
}

double DirectMotion::distance_left() const {
  const double left = target_ ? *target_ - travelled_ : 0.0;
  return std::abs(left) < kThere ? 0.0 : left;
}

}  // namespace saphira::reflector
