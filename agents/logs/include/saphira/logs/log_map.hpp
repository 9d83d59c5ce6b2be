#pragma once

#include <functional>
#include <vector>

#include "saphira/logs/data_set.hpp"
#include "saphira/logs/scan_mapping.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::logs {

/// The walls of a floor and the poses of the robot, from the laser scans of a log.
struct LogMap {
  maps::Map walls;                 ///< WALL lines; the first pose of the log is about the origin
  std::vector<StampedPose> poses;  ///< of the robot in the map, one for each scan
  ScanMapReport report;
};

/// Maps a log from its whole scans. `goes_on` is called after each scan; std::runtime_error where
/// it returns false, and for a log without scans.
LogMap map_log(
    const DataSet& log, const std::function<bool()>& goes_on = [] { return true; });

inline constexpr double kWithin = 0.5;  ///< [m] tolerance of a right pose

/// The distances of poses from the laser's.
struct Accuracy {
  double ate = 0.0;            ///< [m] root mean square after the best alignment
  double drift = 0.0;          ///< [m] over 10 m of way, median
  double drift_heading = 0.0;  ///< [rad] the same
  double within = 0.0;         ///< [0..1] share of the poses within kWithin, in that alignment
  std::size_t compared = 0;    ///< poses; below 2 the other members are unknown
};
Accuracy accuracy(const std::vector<StampedPose>& poses, const Trajectory& truth);

/// Localization by sonars on a map, over a log.
struct LogEvaluation {
  Accuracy dead_reckoning;
  Accuracy localized;  ///< while the robot has a pose
  Accuracy tracked;    ///< while the robot is sure of it
  SonarRun run;
};

/// Interpretation and registration, as in the services, with virtual sonar readings from the laser.
/// `laser` is of the same log. Without a start the robot has to find its pose.
LogEvaluation evaluate_log(const DataSet& log, const LogMap& laser,
                           const std::vector<lps::SonarMount>& sonars, const maps::Map& map,
                           std::optional<Pose> start_in_map);

}  // namespace saphira::logs
