#include "saphira/reflector/odometry.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/protocol/information.hpp"

namespace saphira::reflector {

namespace {

constexpr double kCounts = 32768.0;  // of a position, before it rolls over

}  // namespace

void Odometry::connect(std::optional<OdometryMemory> memory, std::uint64_t fresh,
                       const Slack& slack) {
  first_ = true;
  remembered_ = memory;
  fresh_ = fresh;
  slack_ = slack;
}

void Odometry::begin(const RawPose& raw, std::uint64_t odom) {
  memory_.odom = odom;
  memory_.raw = raw;
  memory_.raw_unwrapped = {raw.x * settings_.distance_unit, raw.y * settings_.distance_unit,
                           norm2_angle(raw.th)};
  memory_.server_in_odom = relative(memory_.raw_unwrapped, {0.0, 0.0, 0.0});
  pose_ = {};
  advance_ = 0.0;
}

bool Odometry::update(const RawPose& raw, double dt, std::uint64_t fresh) {
  double allowed = 0.0;
  double allowed_turn = 0.0;
  if (first_) {
    first_ = false;
    const bool power_up = raw.x == 0 && raw.y == 0 && raw.th == 0.0;
    if (!remembered_ || power_up) {
      begin(raw, fresh_);
      return true;
    }
    memory_ = *remembered_;
    // Beyond half the range of the counters, the direction is ambiguous.
    allowed = std::min(settings_.near_distance + slack_.distance,
                       std::max(settings_.near_distance, 0.4 * kCounts * settings_.distance_unit));
    allowed_turn = settings_.near_angle + slack_.angle;
    fresh = fresh_;
  } else {
    allowed = settings_.near_distance + 1.5 * settings_.max_velocity * dt;
    allowed_turn = settings_.near_angle + 1.5 * settings_.max_rotation_velocity * dt;
  }

  const double dx = protocol::position_difference(memory_.raw.x, raw.x) * settings_.distance_unit;
  const double dy = protocol::position_difference(memory_.raw.y, raw.y) * settings_.distance_unit;
  if (std::hypot(dx, dy) > allowed ||
      std::abs(norm2_angle(raw.th - memory_.raw.th)) > allowed_turn) {
    begin(raw, fresh);
    return true;
  }
  const double middle =
      memory_.raw_unwrapped.th + norm2_angle(raw.th - memory_.raw_unwrapped.th) / 2.0;
  advance_ = dx * std::cos(middle) + dy * std::sin(middle);
  memory_.raw = raw;
  memory_.raw_unwrapped.x += dx;
  memory_.raw_unwrapped.y += dy;
  memory_.raw_unwrapped.th = norm2_angle(raw.th);
  pose_ = compose(memory_.server_in_odom, memory_.raw_unwrapped);
  return false;
}

}  // namespace saphira::reflector
