#pragma once

#include <string>
#include <vector>

#include "metrics.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/registration/scan_matching.hpp"
#include "virtual_sonar.hpp"

namespace saphira::bench {

/// A drive as perception gets it: dead reckoning and what the sonars hear, at stamps.
struct SonarDrive {
  SonarRing ring;
  std::vector<double> times;
  std::vector<Pose> poses_in_odom;
  std::vector<std::vector<lps::SonarReading>> readings;
  /// The readings of a stamp are of one moment, as those of a laser; else they came one after the
  /// other since the stamp before.
  bool at_once = false;
};

/// [s] Of this program alone: other work on the machine does not count.
double cpu_seconds();

struct SonarRun {
  std::vector<StampedPose> poses;  ///< in the map, from when it is placed
  std::size_t steps = 0;
  std::size_t tracking = 0;
  std::size_t lost = 0;
  std::size_t unplaced = 0;
  std::size_t walls = 0;  ///< percepts that were new, by kind
  std::size_t openings = 0;
  std::size_t accepted = 0;     ///< matches; of map building, loops closed
  std::size_t features = 0;     ///< of the map that was built
  std::vector<double> step_ms;  ///< of CPU
};

/// Interpretation and registration over the drive, beginning at `start_in_map` if it is known.
SonarRun register_sonars(const SonarDrive& drive, const maps::Map& map,
                         std::optional<Pose> start_in_map);

/// Interpretation and map building, from nothing.
SonarRun map_sonars(const SonarDrive& drive, const Pose& start_in_map);

}  // namespace saphira::bench
