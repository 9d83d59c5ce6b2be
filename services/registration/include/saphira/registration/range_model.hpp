#pragma once

#include "saphira/geometry/pose.hpp"
#include "saphira/registration/line_map.hpp"

namespace saphira::registration {

/// The expected range of a sonar at a place of the map. Surfaces are mirrors to it (sim/README.md,
/// "Against real sonars"). A surface at a right angle is heard; one at a slant mostly is not, and
/// then the echo comes from a corner, a door post, or an object that is not in the map.
struct RangeModelSettings {
  double facing = radians(15.0);  ///< [rad] largest angle of a surface's normal that is heard
  double cone = radians(10.0);    ///< [rad] half of it, for other echoes
  double sigma = 0.08;            ///< [m] of an echo of a mapped surface, with the map's errors
  double slanted_sigma = 0.12;    ///< [m] the same for the others
  double heard = 0.85;            ///< share of firings with the echo of a facing surface
  double near = 0.02;             ///< share of nearer echoes, within 0.2 m of range
  double far = 0.008;             ///< the same of farther echoes
  double silent = 0.04;           ///< share of firings at a facing surface without an echo
  double slanted_silent = 0.6;    ///< share without an echo where no surface faces the sonar
  double slanted_heard = 0.25;    ///< share with an echo of a mapped surface
  double slanted_other = 0.03;    ///< share with an echo of another object, within 0.2 m
  double max_range = 5.0;         ///< [m]
};

class RangeModel {
 public:
  explicit RangeModel(const Field& field, RangeModelSettings settings = {});

  /// The log likelihood of a reading, for comparison between poses. `ahead`: the unit vector along
  /// the sensor's axis.
  double log_likelihood(const Vec2& sensor_in_map, const Vec2& ahead, double range,
                        bool echo) const;

 private:
  double arc_distance(const Vec2& from, const Vec2& ahead, double range) const;
  bool blocked(const Vec2& from, const Vec2& ahead, double free, double range) const;

  const Field* field_;
  RangeModelSettings settings_;
  double facing_;  ///< cosine
  Vec2 off_axis_;  ///< the unit vector of the places beside the axis, seen from it
  double log_silent_;
  double log_slanted_silent_;
  double log_far_;
};

}  // namespace saphira::registration
