#pragma once

#include <vector>

#include "saphira/authority/echo_map.hpp"
#include "saphira/authority/guard.hpp"
#include "saphira/protocol/information.hpp"
#include "saphira/protocol/parameters.hpp"

namespace saphira::authority {

/// The guard's view of a robot.
Body body_of(const protocol::RobotParameters& parameters);

/// The readings of a packet, without sonars that the parameters do not place.
std::vector<Reading> readings_of(const std::vector<protocol::Sonar>& sonars,
                                 const protocol::RobotParameters& parameters);

}  // namespace saphira::authority
