#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "saphira/lps/seen_thing.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::agent_interface {

/// The newest arm of the people in view, as their place on the map with the heading of the arm.
/// None where nobody has pointed in the last 2 s. Of several the one that is nearest to the robot.
std::optional<Pose> pointing(const std::vector<lps::SeenThing>& things, std::uint64_t cycle,
                             const Pose& odom_in_map, const Vec2& robot_in_map);

/// The doorway at which an arm points, within 5 m; nullptr: none. A doorway that is nearer, and
/// more in the arm's direction, goes before others; none is more than 45 degrees beside it.
const maps::Feature* doorway_at(const maps::Map& map, const Pose& arm_in_map);

/// The room or corridor with a name, or any corridor alone, in which most of the 5 m before an arm
/// lie; nullptr: none.
const maps::Feature* area_at(const maps::Map& map, const Pose& arm_in_map, bool corridors_alone);

}  // namespace saphira::agent_interface
