#pragma once

#include "saphira/behaviors/executive.hpp"
#include "saphira/protocol/parameters.hpp"

namespace saphira::behaviors {

/// Of a robot's parameter file.
inline RobotModel model_of(const protocol::RobotParameters& parameters) {
  RobotModel model;
  model.radius = parameters.radius;
  model.max_velocity = parameters.max_velocity;
  model.max_rotation_velocity = parameters.max_rotation_velocity;
  model.deceleration = parameters.deceleration;
  model.lps.front_buffer = static_cast<std::size_t>(parameters.front_buffer);
  model.lps.side_buffer = static_cast<std::size_t>(parameters.side_buffer);
  model.lps.front_max_range = parameters.front_max_range;
  for (const protocol::SonarUnit& unit : parameters.sonars)
    model.lps.sonars.push_back({unit.number, unit.pose_in_robot});
  return model;
}

}  // namespace saphira::behaviors
