#pragma once

#include <functional>
#include <vector>

#include "saphira/logs/data_set.hpp"
#include "saphira/logs/scan_mapping.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::logs {

/// The walls of a floor and the poses of the robot, from the laser scans of a log.
struct LogMap {
  maps::Map walls;          ///< WALL lines; the first pose of the log is about the origin
  std::vector<Pose> poses;  ///< of the robot in the map, one for each scan
  ScanMapReport report;
};

/// Maps a log from its whole scans. `goes_on` is called after each scan; std::runtime_error where
/// it returns false, and for a log without scans.
LogMap map_log(
    const DataSet& log, const std::function<bool()>& goes_on = [] { return true; });

}  // namespace saphira::logs
