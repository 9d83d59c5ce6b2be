#include "saphira/authority/robot.hpp"

#include <algorithm>

#include "saphira/authority/coverage.hpp"

namespace saphira::authority {

namespace {

constexpr double kLinkAndServer = 0.2;  // [s] packet, decision, command, motors

}  // namespace

Body body_of(const protocol::RobotParameters& parameters) {
  Body body{.radius = parameters.radius,
            .max_velocity = parameters.max_velocity,
            .max_rotation_velocity = parameters.max_rotation_velocity,
            .deceleration = parameters.deceleration,
            .sonar_range = parameters.sonar_max_range};
  // The mean wait for a sonar's turn is half a round.
  const double round = parameters.sonar_period * static_cast<double>(parameters.sonars.size()) /
                       std::max(parameters.sonar_arrays, 1);
  body.reaction = 0.5 * round + kLinkAndServer;
  if (body.sonar_range >= 1.0) {
    body.sweep_ahead = swing(parameters.sonars, true);
    body.sweep_behind = swing(parameters.sonars, false);
  }
  return body;
}

std::vector<Reading> readings_of(const std::vector<protocol::Sonar>& sonars,
                                 const protocol::RobotParameters& parameters) {
  std::vector<Reading> readings;
  for (const protocol::Sonar& sonar : sonars)
    for (const protocol::SonarUnit& unit : parameters.sonars)
      if (unit.number == sonar.number)
        readings.push_back({sonar.number, unit.pose_in_robot,
                            sonar.echo ? std::optional<double>(sonar.range) : std::nullopt});
  return readings;
}

}  // namespace saphira::authority
