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

double left_of(const Move& move, const v1::Grant& grant, const v1::RobotState& robot) {
  switch (move.kind) {
    case Move::Kind::move:
      return std::abs(grant.distance_left);
    case Move::Kind::turn:
      return std::abs(norm2_angle(grant.heading - robot.pose_in_odom.th));
    case Move::Kind::speed:
      break;
  }
  return 0.0;
}

bool done(const Move& move, const v1::Grant& grant, const v1::RobotState& robot) {
  switch (move.kind) {
    case Move::Kind::move:
      return grant.distance_left == 0.0 && std::abs(robot.velocity) < kStands;
    case Move::Kind::turn:
      return grant.rotation == v1::ROTATION_HEADING && left_of(move, grant, robot) <= kThere &&
             std::abs(robot.rotation_velocity) < kDoesNotTurn;
    case Move::Kind::speed:
      break;
  }
  return false;
}

std::string rest_of(const Move& move, const v1::Grant& grant, const v1::RobotState& robot) {
  const double left = left_of(move, grant, robot);
  if (move.kind == Move::Kind::move && left > 0.0)
    return format(", %.2f m left", left);
  if (move.kind == Move::Kind::turn && left > kThere)
    return format(", %.0f degrees left", degrees(left));
  return {};
}

}  // namespace saphira::cli
