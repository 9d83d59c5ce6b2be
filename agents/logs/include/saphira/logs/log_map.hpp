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

/// Maps a log from its whole scans. `goes_on` is asked after each scan; std::runtime_error where it
/// says no, and where the log has no scan.
LogMap map_log(
    const DataSet& log, const std::function<bool()>& goes_on = [] { return true; });

inline constexpr double kWithin = 0.5;  ///< [m] so near a pose is right

/// How far from where the laser says the robot was.
struct Accuracy {
  double ate = 0.0;            ///< [m] root mean square after the best alignment
  double drift = 0.0;          ///< [m] over 10 m of way, median
  double drift_heading = 0.0;  ///< [rad] the same
  double within = 0.0;         ///< [0..1] share of the poses within kWithin, aligned in that way
  std::size_t compared = 0;    ///< poses; below 2 nothing else is known
};
Accuracy accuracy(const std::vector<StampedPose>& poses, const Trajectory& truth);

/// Localization by sonars on a map, over a log.
struct LogEvaluation {
  Accuracy dead_reckoning;
  Accuracy localized;  ///< while the robot has a pose
  SonarRun run;
};

/// Interpretation and registration, as the services have them, with what sonars would have heard
/// where the laser scanned. `laser` is of the same log. Without a start the robot has to find it.
LogEvaluation evaluate_log(const DataSet& log, const LogMap& laser,
                           const std::vector<lps::SonarMount>& sonars, const maps::Map& map,
                           std::optional<Pose> start_in_map);

}  // namespace saphira::logs
