#pragma once

#include <cstdint>
#include <string>

#include "map.h"
#include "saphira/maps/map.hpp"
#include "saphira/registration/registration.hpp"

/// Between the types of the bus and those of the library: pure functions, nothing else.
namespace saphira::registration {

/// The registration sample of a step at `pose_in_odom`; stamp, odom, revision and switches are the
/// caller's. The map is the one that the output speaks of.
v1::Registration to_bus(const Output& output, const maps::Map& map, const Pose& pose_in_odom);

}  // namespace saphira::registration
