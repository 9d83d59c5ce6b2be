#pragma once

#include <string>
#include <vector>

#include "saphira/logs/metrics.hpp"
#include "saphira/logs/scan_matching.hpp"
#include "saphira/logs/sonar_run.hpp"

namespace saphira::logs {

/// A drive of a robot with a laser.
struct DataSet {
  std::string name;
  std::vector<double> times;  ///< of the scans [s]
  std::vector<Pose> poses_in_odom;
  std::vector<Scan> scans;
  Trajectory odometry{{}};           ///< denser than the scans if the log is
  std::vector<std::string> damaged;  ///< unreadable lines of the log
  std::vector<std::string> notes;    ///< assumptions made in reading the log
};

/// A log's drive, by a clock of the log that was not set back, if there is one.
DataSet load_data_set(const std::string& name, const std::string& path);

/// The readings of a ring of sonars on that drive, derived from the laser scans.
SonarDrive virtual_drive(const DataSet& set, std::vector<lps::SonarMount> mounts);

}  // namespace saphira::logs
