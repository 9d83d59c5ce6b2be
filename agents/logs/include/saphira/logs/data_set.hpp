#pragma once

#include <optional>
#include <string>
#include <vector>

#include "saphira/logs/metrics.hpp"
#include "saphira/logs/scan_matching.hpp"
#include "saphira/logs/sonar_run.hpp"
#include "saphira/logs/stamps.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::logs {

/// A drive with the known poses of the robot.
struct DataSet {
  std::string name;
  std::vector<double> times;  ///< of the scans [s]
  std::vector<Pose> poses_in_odom;
  std::vector<Scan> scans;
  Trajectory odometry{{}};  ///< denser than the scans if the log is
  std::optional<Trajectory> reference;
  std::vector<Relation> relations;
  std::vector<Relation> exact_relations;  ///< those whose stamps are both stamps of scans here
  std::size_t mended = 0;                 ///< scans whose stamps were interpolated in the log
  std::vector<std::string> damaged;       ///< unreadable lines of the log
  std::vector<std::string> notes;         ///< assumptions made in reading the log

  bool ranges_only = false;  ///< a drive without sonars, with no virtual sonars from its ranges

  // Of simulated drives only.
  std::optional<SonarDrive> sonars;
  std::optional<maps::Map> map;
};

struct LogFiles {
  std::string name;
  std::string raw;
  std::string corrected;  ///< empty: none
  std::string relations;  ///< empty: none
};

/// The logs in a folder of data sets and in each folder in it: raw logs, each with a corrected one
/// and relations, matched by their names. A log that is alone in its folder has the folder's name.
std::vector<LogFiles> find_logs(const std::string& folder);

/// The records of a log by one of its clocks, with the scans in the log's order.
DataSet data_set_of(const std::string& name, const CarmenLog& log, Clock clock);

DataSet load_data_set(const std::string& name, const LogFiles& files);

/// The readings of a ring of sonars on that drive, derived from the laser scans.
SonarDrive virtual_drive(const DataSet& set, std::vector<lps::SonarMount> mounts);

}  // namespace saphira::logs
