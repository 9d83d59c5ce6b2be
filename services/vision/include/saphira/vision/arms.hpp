#pragma once

#include <optional>

#include "saphira/vision/census.hpp"
#include "saphira/vision/picture.hpp"
#include "saphira/vision/sight.hpp"

namespace saphira::vision {

struct ArmSettings {
  double low = 1.15;       ///< [m] above the floor: an arm is higher,
  double high = 1.65;      ///< [m] and lower
  double thinnest = 0.04;  ///< [m] from its lower to its upper edge
  double thickest = 0.30;  ///< [m]
  double begin = 0.32;     ///< [m] from the person's middle: outside of the torso
  double nearest = 0.45;   ///< [m] of the finger tips from there, across the line of sight
  double farthest = 1.00;  ///< [m]
  double deep = 0.20;      ///< [m] of one surface in a column, and two sigmas
  double gap = 0.10;       ///< [m] without a match, within an arm
  double reach = 0.85;     ///< [m] before or behind the person's middle
};

/// The direction in the robot's frame [rad] of an arm that a person stretches out to the left or
/// right (paper 4.2): a bar at the height of the shoulders that begins beside the torso, with
/// nothing below it. None where there is such a bar on neither side or on both, or where its end is
/// less than `nearest` beside the person's middle.
std::optional<double> arm_of(const Sight& person, const DisparityMap& map, const Rig& rig, int rows,
                             const ArmSettings& settings = {});

}  // namespace saphira::vision
