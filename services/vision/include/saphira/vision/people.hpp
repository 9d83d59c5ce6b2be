#pragma once

#include <array>
#include <optional>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/vision/census.hpp"
#include "saphira/vision/sight.hpp"

namespace saphira::vision {

/// Heights above the floor at which people are looked for [m]: an adult's torso (paper 3.2.3).
inline constexpr std::array<double, 3> kTorso{1.0, 1.2, 1.4};

/// Where the first thing is at one height, column by column from the left, in the frame of the
/// robot [m]; nothing where no match was found.
using Band = std::vector<std::optional<Vec2>>;

/// Ranges of stereo at the heights of a torso.
struct Bands {
  std::array<Band, kTorso.size()> bands;
  Band above;                ///< likewise above people's heads; empty: not looked at
  double eye_forward = 0.0;  ///< [m] of the cameras, before the robot's centre
  /// [1/m] A range z is uncertain by this times z squared: one sigma.
  double uncertainty = 0.01;

  bool operator==(const Bands&) const = default;
};

Bands bands_of(const DisparityMap& map, const Rig& rig, int rows);
/// The rows of a picture in which a torso can be that is no nearer than a step.
std::pair<int, int> torso_rows(const Rig& rig, int rows);

struct PeopleSettings {
  double narrowest = 0.30;  ///< [m] of a torso
  double widest = 0.80;     ///< [m]
  double deepest = 0.40;    ///< [m] between its nearest and farthest point that is seen
  double apart = 0.35;      ///< [m] what is nearer in range belongs together
  double nearest = 0.5;     ///< [m]
  double farthest = 6.0;    ///< [m]
  double radius = 0.20;     ///< [m] the middle is so far behind its front
  /// [m] What is flatter than this is a piece of wall: how much nearer the middle is than the
  /// sides.
  double round = 0.03;
  double agree = 0.30;  ///< [m] between the middles of what two bands show
};

/// Person-like things: of the width of an adult, before what is farther, in two bands of three; not
/// flat, where that can be told, and not going on above a head.
std::vector<Sight> find_people(const Bands& bands, const PeopleSettings& settings = {});

/// True where a person at a place of the robot's frame would be seen: within the picture, and
/// nothing that is nearer stands before.
bool in_view(const Bands& bands, const Vec2& place_in_robot, const PeopleSettings& settings = {});

}  // namespace saphira::vision
