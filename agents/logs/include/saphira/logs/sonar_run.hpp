#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "saphira/interpretation/interpretation.hpp"
#include "saphira/logs/metrics.hpp"
#include "saphira/logs/scan_matching.hpp"
#include "saphira/logs/virtual_sonar.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::logs {

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

/// A step of interpretation on the way.
struct Perceived {
  std::uint64_t cycle = 0;
  std::size_t stamp = 0;  ///< which of the drive's
  const interpretation::Output* output = nullptr;
  const std::vector<lps::SonarReading>* readings = nullptr;
  /// It holds the readings of this stamp. Where all readings are of one moment, the way to it is a
  /// step of its own, before.
  bool complete = true;
};
/// Interpretation alone over the drive. `odom_in_grid` may say at each stamp where its grid is.
void perceive(const SonarDrive& drive, interpretation::Interpretation& interpretation,
              const std::vector<Pose>* odom_in_grid,
              const std::function<void(const Perceived&)>& look);

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

}  // namespace saphira::logs
