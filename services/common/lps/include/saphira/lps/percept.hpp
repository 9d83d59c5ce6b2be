#pragma once

#include <cstdint>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/lps/artifact.hpp"

namespace saphira::lps {

/// The side of the robot with the percept.
enum class Side { none, left, right };

/// A sonar reading's place on the bus: the cycle of the RobotState and the sonar's number.
struct ReadingId {
  std::uint64_t cycle = 0;
  int sonar = 0;

  bool operator==(const ReadingId&) const = default;
};

/// A result of sensor interpretation: a feature (a stretch of wall, one end of an opening) or an
/// object hypothesis (a door, a junction, a corridor), paper 3.2.1. It includes its readings, its
/// confidence, and its age.
///
/// In odom, where it keeps its place as long as dead reckoning is accurate.
struct Percept {
  std::uint32_t id = 0;  ///< stays for the same object; never used again
  /// wall: a stretch of surface. breach: one end of an opening (a wall ends here). door: an opening
  /// of a door's width, or a closed door that stands back from the wall. junction: a wider opening.
  /// corridor: two parallel walls.
  PointType type = PointType::invalid;
  Side side = Side::none;
  /// The middle; of a breach, the end of the wall. The heading is along a wall or corridor, roughly
  /// in the robot's direction when it saw it; of a door, junction or breach it is the normal of the
  /// opening, towards the side of the robot.
  Pose pose_in_odom;
  /// [m] of walls and corridors; of a door its setback from the wall, 0: it is open.
  double length = 0.0;
  double width = 0.0;  ///< [m] of corridors, and of openings
  /// One sigma, in the percept's own frame: along and across its heading [m], and of it [rad].
  double sigma_along = 0.0;
  double sigma_across = 0.0;
  double sigma_heading = 0.0;
  double confidence = 0.0;  ///< [0..1] that the object exists
  std::uint64_t since = 0;  ///< cycle when it was seen first
  std::uint64_t seen = 0;   ///< cycle of the newest reading that made it
  std::vector<ReadingId> readings;

  bool operator==(const Percept&) const = default;

  /// A door that is closed.
  bool is_closed() const { return type == PointType::door && length > 0.0; }
  /// A hypothesis of an object, not only a feature.
  bool is_hypothesis() const {
    return type == PointType::door || type == PointType::junction || type == PointType::corridor;
  }
};

}  // namespace saphira::lps
