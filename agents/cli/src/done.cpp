#include "saphira/cli/done.hpp"

#include <cmath>

#include "saphira/base/format.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::cli {
namespace {

constexpr double kFarthest = 100.0;            // [m]
constexpr double kFastest = 5.0;               // [m/s]
constexpr double kThere = radians(2.0);        // the resolution of the manual's robots
constexpr double kStands = 0.02;               // [m/s]
constexpr std::uint64_t kGap = 5;              // cycles, as of a person: see authority::Settings
constexpr double kDoesNotTurn = radians(3.0);  // [rad/s]

}  // namespace

std::string trouble_of(const Move& move) {
  const double value = move.value;
  switch (move.kind) {
    case Move::Kind::move:
      if (value == 0.0 || std::abs(value) > kFarthest)
        return format("move: expected meters from -100 to 100 and not 0, found %g", value);
      break;
    case Move::Kind::turn:
      if (value == 0.0 || std::abs(value) > kPi + 1e-9)
        return format("turn: expected degrees from -180 to 180 and not 0, found %g",
                      degrees(value));
      break;
    case Move::Kind::speed:
      if (std::abs(value) > kFastest)
        return format("speed: expected meters a second from -5 to 5, found %g", value);
      break;
  }
  return {};
}

v1::MotorCommand command_of(const Move& move) {
  v1::MotorCommand command{.active = true, .move = 1};
  switch (move.kind) {
    case Move::Kind::move:
      command.translation = v1::TRANSLATION_POSITION;
      command.distance = move.value;
      command.velocity = move.speed;
      break;
    case Move::Kind::turn:
      command.rotation = v1::ROTATION_RELATIVE_HEADING;
      command.heading = move.value;
      break;
    case Move::Kind::speed:
      command.translation = v1::TRANSLATION_VELOCITY;
      command.velocity = move.value;
      break;
  }
  return command;
}

Course::State Course::update(bool drives, const v1::Grant& grant, const v1::RobotState& robot) {
  const v1::Stamp before = driving_.stamp;
  if (before.epoch != 0)
    interrupted_ = interrupted_ || grant.stamp.epoch != before.epoch ||
                   grant.stamp.cycle > before.cycle + kGap ||
                   (!drives && move_.kind != Move::Kind::speed);
  if (drives && !interrupted_)
    driving_ = grant;
  if (driving_.stamp.epoch == 0)
    return State::waits;
  bool at_rest = false;
  double there = 0.0;
  switch (move_.kind) {
    case Move::Kind::move:
      left_ = std::abs(driving_.distance_left);
      at_rest = std::abs(robot.velocity) < kStands;
      break;
    case Move::Kind::turn:
      left_ = std::abs(norm2_angle(driving_.heading - robot.pose_in_odom.th));
      at_rest = driving_.rotation == v1::ROTATION_HEADING &&
                std::abs(robot.rotation_velocity) < kDoesNotTurn;
      there = kThere;
      break;
    case Move::Kind::speed:
      return interrupted_ ? State::interrupted : State::drives;
  }
  if (interrupted_)
    return State::interrupted;
  return at_rest && left_ <= there ? State::done : State::drives;
}

std::string Course::rest() const {
  if (move_.kind == Move::Kind::move && left_ > 0.0)
    return format(", %.2f m left", left_);
  if (move_.kind == Move::Kind::turn && left_ > kThere)
    return format(", %.0f degrees left", degrees(left_));
  return {};
}

}  // namespace saphira::cli
