#pragma once

#include <vector>

#include "saphira/maps/map.hpp"
#include "saphira/registration/scan_matching.hpp"

namespace saphira::bench {

/// The straight walls of at least 0.3 m in scans with known poses, as a map of WALL lines: what a
/// person would draw from them. Doors and corridors are not made of them.
maps::Map walls_of(const std::vector<registration::Scan>& scans, const std::vector<Pose>& poses);

}  // namespace saphira::bench
