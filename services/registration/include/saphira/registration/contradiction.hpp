#pragma once

#include "saphira/geometry/pose.hpp"
#include "saphira/registration/line_map.hpp"

namespace saphira::registration {

/// Log likelihood ratios: how much likelier what was heard or seen is at another place of the map
/// than at this one. Shares of readings on made floors (tests/bench/floors) of robots at the
/// believed place and of robots that were carried, to the power of about 0.5: readings repeat each
/// other.
struct ContradictionSettings {
  double facing = radians(15.0);  ///< [rad] largest angle of a surface's normal that is heard
  double range = 4.7;             ///< [m] the farthest surface that is heard
  double exact = 0.12;            ///< [m] an echo this near its surface...
  double agrees = -0.5;           ///< ...supports the place
  double rough = 0.3;             ///< [m] an echo this near, of another surface most likely...
  double differs = 0.7;           ///< ...contradicts
  double denies = 1.0;  ///< an echo farther off: through a wall, or of nothing that is mapped
  double silent = 0.5;  ///< no echo
  double wall = 1.0;    ///< a wall that the map does not have
};

/// Of one reading. 0 where no surface of the map faces the sonar.
double contradiction(const Field& field, const Pose& sensor_in_map, double range, bool echo,
                     const ContradictionSettings& settings = {});

}  // namespace saphira::registration
