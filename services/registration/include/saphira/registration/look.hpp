#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::registration {

/// A reading of a sonar, and where the sonar was.
struct Look {
  Pose sensor_in_map;
  double range = 0.0;  ///< [m]
  bool echo = false;

  /// Where the echo came from if it came from the axis.
  Vec2 end() const { return sensor_in_map.position() + range * sensor_in_map.direction(); }
  bool operator==(const Look&) const = default;
};

/// How far apart looks must be not to repeat each other: in place or in bearing.
struct LookSpacing {
  double way = 0.15;            ///< [m]
  double turn = radians(12.0);  ///< [rad]

  bool operator==(const LookSpacing&) const = default;
};

/// Takes a look from there to the others. False, and not taken, where it repeats one of them.
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
