#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::registration {

/// A reading of a sonar, with the sonar's place.
struct Look {
  Pose sensor_in_map;
  double range = 0.0;  ///< [m]
  bool echo = false;

  /// The origin of the echo, if it came from the axis.
  Vec2 end() const { return sensor_in_map.position() + range * sensor_in_map.direction(); }
};

/// The distance of independent looks: in place or in bearing.
struct LookSpacing {
  double way = 0.15;            ///< [m]
  double turn = radians(12.0);  ///< [rad]
};

/// Adds a look to the others. False, and not added, where it repeats one of them.
inline bool take_look(std::vector<Pose>& looks, const Pose& sensor, const LookSpacing& spacing) {
  const bool there = std::any_of(looks.begin(), looks.end(), [&](const Pose& look) {
    return (look.position() - sensor.position()).norm() < spacing.way &&
           std::abs(norm2_angle(look.th - sensor.th)) < spacing.turn;
  });
  if (!there)
    looks.push_back(sensor);
  return !there;
}

}  // namespace saphira::registration
