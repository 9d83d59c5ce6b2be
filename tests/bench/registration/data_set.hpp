#pragma once

#include <optional>
#include <string>
#include <vector>

#include "metrics.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/registration/scan_matching.hpp"
#include "sonar_run.hpp"

namespace saphira::bench {

/// A drive with what is known of where the robot was.
struct DataSet {
  std::string name;
  std::vector<double> times;  ///< of the scans [s]
  std::vector<Pose> poses_in_odom;
  std::vector<registration::Scan> scans;
  Trajectory odometry{{}};  ///< denser than the scans where the log is
  std::optional<Trajectory> reference;
  std::vector<Relation> relations;
  std::vector<Relation> exact_relations;  ///< those whose stamps are both stamps of scans here
  std::size_t mended = 0;                 ///< scans whose stamps were interpolated in the log
  std::vector<std::string> damaged;       ///< lines of the log that could not be read

  // Of simulated drives only.
  std::optional<SonarDrive> sonars;
  std::optional<maps::Map> map;
};

struct LogFiles {
  std::string raw;
  std::string corrected;  ///< empty: none
  std::string relations;  ///< empty: none
};

/// The logs in a folder of data sets: each folder in it with a raw log, and beside that a corrected
/// one and relations, known by their names.
std::vector<LogFiles> find_logs(const std::string& folder);

DataSet load_data_set(const std::string& name, const LogFiles& files);

/// A simulated robot on a round through a world of config/worlds (office-floor or loop), with a
/// laser of 180 beams. Dead reckoning errs `errors` times as much as that of the robot's
/// description.
DataSet simulate_data_set(const std::string& world, double errors, std::uint64_t seed, int cycles);

}  // namespace saphira::bench
