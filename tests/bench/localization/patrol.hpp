#pragma once

#include <cstddef>
#include <vector>

#include "drive/drive.hpp"

namespace saphira::test {

/// The errors in each cycle.
struct Offs {
  std::vector<double> position;  // [m]
  std::vector<double> heading;   // [rad]
  void add(const Pose& believed, const Pose& truth);
};

/// Round the corridors of the office floor.
std::vector<Vec2> office_tour();

struct PatrolResult {
  Offs registered;  ///< while it tracks
  Offs reckoned;
  double way = 0.0;         ///< [m]
  std::size_t reached = 0;  ///< points of the tour
  int not_tracking = 0;     ///< cycles
};
/// Drives by its own estimate.
PatrolResult patrol(Drive& robot, const std::vector<Vec2>& points, int cycles);

}  // namespace saphira::test
