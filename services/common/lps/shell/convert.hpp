#pragma once

#include <vector>

#include "geometry/shell/convert.hpp"
#include "saphira/base/namesakes.hpp"
#include "saphira/idl/perception.hpp"
#include "saphira/idl/robot.hpp"
#include "saphira/idl/vision.hpp"
#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/lps/percept.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira {

template <>
inline constexpr EnumPairs<lps::PointType, v1::ArtifactType, 11>
    kPairs<lps::PointType, v1::ArtifactType>{{{
        {lps::PointType::invalid, v1::ARTIFACT_INVALID},
        {lps::PointType::position, v1::ARTIFACT_POSITION},
        {lps::PointType::wall, v1::ARTIFACT_WALL},
        {lps::PointType::corridor, v1::ARTIFACT_CORRIDOR},
        {lps::PointType::lane, v1::ARTIFACT_LANE},
        {lps::PointType::door, v1::ARTIFACT_DOOR},
        {lps::PointType::junction, v1::ARTIFACT_JUNCTION},
        {lps::PointType::office, v1::ARTIFACT_OFFICE},
        {lps::PointType::breach, v1::ARTIFACT_BREAK},
        {lps::PointType::object, v1::ARTIFACT_OBJECT},
        {lps::PointType::zone, v1::ARTIFACT_ZONE},
    }}};

}  // namespace saphira

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
