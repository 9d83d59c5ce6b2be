#pragma once

#include <cstdint>

#include "saphira/geometry/pose.hpp"

namespace saphira::lps {

/// pt_type of manual 6.6.3.1: the kind of object.
enum class PointType {
  invalid,
  position,
  wall,
  corridor,
  lane,
  door,
  junction,
  office,
  breach,  ///< BREAK
  object,
  zone  ///< a part of the floor with a rule for the robot; only on maps
};

/// A directed point, or an object on one (a wall is its middle and a length along it), with its
/// place in the LPS and in the global frame. The point structure of manual 6.6.3.1.
struct Artifact {
  std::uint32_t id = 0;  ///< unique in its LPS; 0: not yet in one
  PointType type = PointType::position;
  Pose local;           ///< in the robot's frame
  Pose global;          ///< in the global frame
  double length = 0.0;  ///< [m] of walls, corridors and lanes
  double width = 0.0;   ///< [m] of corridors, lanes and doors
  bool is_new = false;  ///< snew: just found
  bool viewable = true;
  std::uint64_t matched = 0;    ///< cycle of the last match with a percept
  std::uint64_t announced = 0;  ///< cycle of the last announcement
};

}  // namespace saphira::lps
