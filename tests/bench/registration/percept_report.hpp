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
  maps::Drawing drawing;  ///< what seven sonars saw, calibrated: real, wrong, missed
};

/// What interpretation makes of virtual sonars, with dead reckoning as it is and `calibrated`,
/// against the reference for a log of that folder and against the laser; and the two models of a
/// grid. `full`: where the robot was at the scans.
PerceptReport report_percepts(const logs::DataSet& set, const std::string& log_folder,
                              const std::vector<logs::StampedPose>& full,
                              const std::vector<Pose>& calibrated_in_odom, Report& report);

}  // namespace saphira::bench
