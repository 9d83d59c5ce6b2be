#pragma once

#include <cstdint>

#include "saphira/geometry/pose.hpp"

namespace saphira::lps {

/// A person or a patch of a colour that a camera sees (paper 3.2.3, manual 9), or has seen a short
/// time ago.
///
/// In odom. The place is the estimate for now: out of sight, the thing keeps its velocity for a
/// while, and is then forgotten.
struct SeenThing {
  enum class Kind { person, blob };

  std::uint32_t id = 0;  ///< stays for the same thing; never used again
  Kind kind = Kind::person;
  int channel = -1;  ///< of a blob: 0, 1, 2 for A, B, C
  /// Its middle on the floor; the heading is from there towards the robot.
  Pose pose_in_odom;
  Vec2 velocity_in_odom{0.0, 0.0};  ///< [m/s] zero while unknown
  /// False for a blob of unknown distance: only the direction of its place is meaningful.
  bool range_known = true;
  double sigma = 0.0;   ///< [m] one sigma of its place; where the range is unknown, across the line
  double width = 0.0;   ///< [m] 0: unknown
  double height = 0.0;  ///< [m] 0: unknown
  double area = 0.0;    ///< [0..1] of the picture, of a blob
  double confidence = 0.0;  ///< [0..1] that the thing exists
  std::uint64_t since = 0;  ///< cycle in which it was seen first
  std::uint64_t seen = 0;   ///< cycle in which it was seen last
  /// [rad] Direction of a person's arm, when it was stretched out to a side last, in odom.
  double points_in_odom = 0.0;
  std::uint64_t pointed = 0;  ///< cycle in which that was seen last; 0: never

  bool operator==(const SeenThing&) const = default;
};

}  // namespace saphira::lps
