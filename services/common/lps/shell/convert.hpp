#pragma once

#include <vector>

#include "geometry/shell/convert.hpp"
#include "saphira/idl/perception.hpp"
#include "saphira/idl/robot.hpp"
#include "saphira/idl/vision.hpp"
#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/lps/percept.hpp"
#include "saphira/lps/seen_thing.hpp"

/// Conversions between the types of the bus and those of the LPS, which every service has: pure
/// functions.
namespace saphira::lps {

using saphira::from_bus;
using saphira::to_bus;

PointType from_bus(v1::ArtifactType type);
v1::ArtifactType to_bus(PointType type);

std::vector<SonarMount> mounts_from_bus(const v1::RobotDescription& description);
LpsSettings settings_from_bus(const v1::RobotDescription& description);
std::vector<SonarReading> sonars_from_bus(const v1::RobotState& state);

Percept from_bus(const v1::Percept& percept);
/// With the newest readings, as many as the contract takes.
v1::Percept to_bus(const Percept& percept);

SeenThing from_bus(const v1::SeenThing& thing);
v1::SeenThing to_bus(const SeenThing& thing);

}  // namespace saphira::lps
