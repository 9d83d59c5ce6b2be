#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/lps/percept.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/registration/line_map.hpp"
#include "saphira/registration/pose_filter.hpp"

namespace saphira::registration {

struct MatchSettings {
  double gate = 9.2;                   ///< squared Mahalanobis, two degrees of freedom: 99 %
  double ambiguity = 12.0;             ///< a second artifact within this gate is ambiguous...
  double same_innovation = 0.06;       ///< [m] ...unless it corrects the pose alike, to this
  double same_heading = radians(2.0);  ///< [rad]
  double most_off = 0.7;               ///< [m] in any case: doors are not much farther apart
  double map_error = 0.03;             ///< [m] one sigma of the map's lines and doors
  double map_heading = radians(0.5);   ///< [rad] the same
  double width = 0.35;                 ///< [m] difference of openings in width
  double corridor_width = 0.3;         ///< [m] the same for corridors
  double most_turned = radians(30.0);  ///< [rad] between a percept and its match
};

/// The result of matching a percept.
struct Match {
  std::uint32_t percept = 0;
  std::optional<std::size_t> feature;  ///< in the map: the nearest of its kind
  std::uint32_t artifact = 0;          ///< its id; 0 where it has none
  /// Seen minus expected: [m] in the map, across a wall for walls and corridors; heading [rad].
  Vec2 offset{0.0, 0.0};
  double turned = 0.0;
  double distance = 0.0;  ///< squared Mahalanobis
  bool accepted = false;
  bool ambiguous = false;  ///< several artifacts fit
  std::string reason;      ///< the reason without a match

  bool operator==(const Match&) const = default;
};

/// Matches a percept with the map's features of its kind, at the filter's pose, and corrects the
/// filter where only one fits (facts of anchoring: paper 3.2).
///
/// A wall or corridor corrects across and the heading; a door, junction or end of a wall both ways.
Match match(const lps::Percept& percept, const Pose& robot_in_odom, const maps::Map& map,
            const LineMap& lines, const MatchSettings& settings, PoseFilter& filter);

}  // namespace saphira::registration
