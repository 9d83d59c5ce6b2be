#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report.hpp"
#include "saphira/logs/data_set.hpp"
#include "saphira/maps/drawing.hpp"

namespace saphira::bench {

struct PerceptReport {
  nlohmann::json percepts;
  nlohmann::json grid;
  maps::Drawing drawing;  ///< percepts of seven sonars, calibrated: real, wrong, missed
};

/// The percepts of interpretation from virtual sonars, with raw and with calibrated dead reckoning
/// (`calibrated_in_odom`), against the reference for a log of that folder and against the laser;
/// and the two grid models. `full`: the robot's poses at the scans.
PerceptReport report_percepts(const logs::DataSet& set, const std::string& log_folder,
                              const std::vector<logs::StampedPose>& full,
                              const std::vector<Pose>& calibrated_in_odom, Report& report);

}  // namespace saphira::bench
