#pragma once

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

}  // namespace saphira::lps
