#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "saphira/logs/metrics.hpp"
#include "saphira/logs/virtual_sonar.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::logs {

/// A drive as input of perception: dead reckoning and sonar readings, at stamps. The readings of a
/// stamp are of one moment.
struct SonarDrive {
  SonarRing ring;
  std::vector<double> times;
  std::vector<Pose> poses_in_odom;
  std::vector<std::vector<lps::SonarReading>> readings;
};

struct SonarRun {
  std::vector<StampedPose> poses;    ///< in the map, from its first placement on
  std::vector<StampedPose> tracked;  ///< of these, those of which the robot is sure
  std::size_t steps = 0;
  std::size_t lost = 0;
  std::size_t unplaced = 0;
  std::size_t accepted = 0;  ///< matches
};

/// Interpretation and registration over the drive, beginning at `start_in_map` if it is known.
SonarRun register_sonars(const SonarDrive& drive, const maps::Map& map,
                         std::optional<Pose> start_in_map);

}  // namespace saphira::logs
