#pragma once

#include <string>
#include <vector>

#include "saphira/intentions/navigation.hpp"
#include "saphira/maps/zones.hpp"

/// The zones of the map and by advice, for the activities that drive.
namespace saphira::intentions {

/// None without a map. They are made once for each change of the beliefs in a cycle.
const std::vector<maps::Zone>& zones_of(const World& world);

/// The reason why the robot is not to go to a point: a keep-out, or a point on the map outside of
/// its rooms and corridors. In words behind the point; empty: it may, or the point's place on the
/// map is not known.
std::string why_no_goal(const World& world, const Pose& point, Frame frame);

/// The keep-out before the robot, which ends its way within the next metre or so; empty: none.
std::string keep_out_ahead(const World& world, bool backwards = false);

}  // namespace saphira::intentions
