#pragma once

#include "saphira/idl/map.hpp"
#include "saphira/registration/core.hpp"

/// Conversions between the types of the bus and those of the library: pure functions.
namespace saphira::registration {

/// The registration sample of a step at `pose_in_odom`; stamp, odom, revision and switches are the
/// caller's.
v1::Registration to_bus(const Core::Outputs& outputs, const Pose& pose_in_odom);

}  // namespace saphira::registration
