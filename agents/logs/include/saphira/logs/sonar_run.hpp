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

/// A drive as input of perception: dead reckoning and sonar readings, at stamps.
struct SonarDrive {
  SonarRing ring;
  std::vector<double> times;
  std::vector<Pose> poses_in_odom;
  std::vector<std::vector<lps::SonarReading>> readings;
  /// True: the readings of a stamp are of one moment, as from a laser. False: they came one after
  /// the other since the stamp before.
  bool at_once = false;
};

/// A step of interpretation on the way.
struct Perceived {
  std::uint64_t cycle = 0;
  std::size_t stamp = 0;  ///< index of the drive's stamp
  const interpretation::Output* output = nullptr;
  const std::vector<lps::SonarReading>* readings = nullptr;
  /// True where the step has the readings of this stamp. If all readings are of one moment, the way
  /// to it is a separate step, before.
  bool complete = true;
};
/// Interpretation alone over the drive. `odom_in_grid` may give the grid's pose at each stamp.
void perceive(const SonarDrive& drive, interpretation::Interpretation& interpretation,
              const std::vector<Pose>* odom_in_grid,
              const std::function<void(const Perceived&)>& look);

/// [s] CPU time of this program alone, without other work on the machine.
double cpu_seconds();

struct SonarRun {
  std::vector<StampedPose> poses;  ///< in the map, from its first placement on
  std::size_t steps = 0;
  std::size_t tracking = 0;
  std::size_t lost = 0;
  std::size_t unplaced = 0;
  std::size_t walls = 0;  ///< new percepts, by kind
  std::size_t openings = 0;
  std::size_t accepted = 0;     ///< matches; in map building, closed loops
  std::size_t features = 0;     ///< of the map that was built
  std::vector<double> step_ms;  ///< of CPU
};

/// Interpretation and registration over the drive, beginning at `start_in_map` if it is known.
SonarRun register_sonars(const SonarDrive& drive, const maps::Map& map,
                         std::optional<Pose> start_in_map);

/// Interpretation and map building, from nothing.
SonarRun map_sonars(const SonarDrive& drive, const Pose& start_in_map);

}  // namespace saphira::logs
