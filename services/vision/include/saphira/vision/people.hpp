#pragma once

#include <array>
#include <optional>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/vision/census.hpp"
#include "saphira/vision/sight.hpp"

namespace saphira::vision {

/// Heights above the floor for the detection of people [m]: an adult's torso (paper 3.2.3).
inline constexpr std::array<double, 3> kTorso{1.0, 1.2, 1.4};

/// The nearest surface at one height, column by column from the left, in the frame of the robot
/// [m]; nothing without a match.
using Band = std::vector<std::optional<Vec2>>;

/// Ranges of stereo at the heights of a torso.
struct Bands {
  std::array<Band, kTorso.size()> bands = {};
  Band above = {};           ///< the same above people's heads; empty: not used
  double eye_forward = 0.0;  ///< [m] of the cameras, before the robot's centre
  /// [m] Of the left camera, whose columns these are; the other is as far to the right.
  double eye_left = 0.0;
  /// [1/m] One sigma of a range z is this times z squared.
  double uncertainty = 0.01;

  bool operator==(const Bands&) const = default;
};

Bands bands_of(const DisparityMap& map, const Rig& rig, int rows);
/// The rows of a picture that can show a torso, no nearer than a step.
std::pair<int, int> torso_rows(const Rig& rig, int rows);

struct PeopleSettings {
  double narrowest = 0.30;  ///< [m] of a torso
  double widest = 0.80;     ///< [m]
  double deepest = 0.40;    ///< [m] between its nearest and farthest visible point
  double apart = 0.35;      ///< [m] largest step of range within one object
  double nearest = 0.5;     ///< [m]
  double farthest = 6.0;    ///< [m]
  double radius = 0.20;     ///< [m] from its front to its middle
  /// [m] Flatter objects are pieces of wall: the middle is nearer than the sides by this.
  double round = 0.03;
  double agree = 0.30;  ///< [m] between the middles in two bands
};

/// Person-like objects: of the width of an adult, before a farther background, in two bands of
/// three; not flat, where that is measurable, and not higher than a head.
std::vector<Sight> find_people(const Bands& bands, const PeopleSettings& settings = {});

/// True where a person at a place in the robot's frame would be seen: within both pictures, not
/// hidden by a nearer object, and not so near that nothing matches.
bool in_view(const Bands& bands, const Vec2& place_in_robot, const PeopleSettings& settings = {});

}  // namespace saphira::vision
