#pragma once

#include "saphira/geometry/pose.hpp"
#include "saphira/registration/line_map.hpp"

namespace saphira::registration {

/// The range that a sonar would measure at a place of the map. Surfaces are mirrors to it
/// (sim/README.md, "Against real sonars"): one that is met at a right angle is heard, one that is
/// met at a slant mostly is not, and then the echo comes from a corner, a door post, or something
/// that is not in the map.
struct RangeModelSettings {
  double facing = radians(15.0);  ///< [rad] a surface whose normal is not more off is heard
  double cone = radians(10.0);    ///< [rad] half of it, for what is heard besides
  double sigma = 0.08;            ///< [m] of an echo of a mapped surface, maps' errors included
  double slanted_sigma = 0.12;    ///< [m] the same of the others
  double heard = 0.85;            ///< share of firings that a facing surface answers
  double near = 0.02;             ///< share that something nearer answers, within 0.2 m of range
  double far = 0.008;             ///< the same of something behind it
  double silent = 0.04;           ///< share that a facing surface does not answer
  double slanted_silent = 0.6;    ///< share without an echo where none faces the sonar
  double slanted_heard = 0.25;    ///< share with an echo of what the map says
  double slanted_other = 0.03;    ///< share with an echo of something else, within 0.2 m
  double max_range = 5.0;         ///< [m]
};

class RangeModel {
 public:
  RangeModel(const Field& field, RangeModelSettings settings = {})
      : field_(&field), settings_(settings) {}

  /// log of how likely a reading is, to be compared between poses.
  double log_likelihood(const Pose& sensor_in_map, double range, bool echo) const;

 private:
  double arc_distance(const Pose& sensor_in_map, double range) const;
  bool blocked(const Pose& sensor_in_map, double range, double margin) const;

  const Field* field_;
  RangeModelSettings settings_;
};

}  // namespace saphira::registration
