#pragma once

#include <string>
#include <vector>

#include "saphira/logs/carmen.hpp"
#include "saphira/logs/scan_matching.hpp"

namespace saphira::logs {

/// A drive of a robot with a laser.
struct DataSet {
  std::string name;
  std::vector<double> times;  ///< of the scans [s]
  std::vector<Pose> poses_in_odom;
  std::vector<Scan> scans;
  std::vector<std::string> damaged;  ///< unreadable lines of the log
  std::vector<std::string> notes;    ///< assumptions made in reading the log

  /// [m] from scan to scan, by dead reckoning.
  double way() const;
};

/// A log's drive, by a clock of the log that was not set back, if there is one.
DataSet load_data_set(const std::string& name, const std::string& path);

}  // namespace saphira::logs
