#pragma once

#include <vector>

#include "saphira/logs/scan_matching.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::logs {

/// The straight walls of at least 0.3 m in scans with known poses, as a map of WALL lines, as a
/// person would draw them. Without doors and corridors.
maps::Map walls_of(const std::vector<Scan>& scans, const std::vector<Pose>& poses);

}  // namespace saphira::logs
