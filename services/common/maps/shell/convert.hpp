#pragma once

#include "saphira/idl/map.hpp"
#include "saphira/maps/map.hpp"

/// Conversions between maps on the bus and those of the library: pure functions.
namespace saphira::maps {

Feature from_bus(const v1::MapArtifact& artifact);
v1::MapArtifact to_bus(const Feature& feature);
Map from_bus(const v1::FloorMap& map);
/// The artifacts; stamp, revision and source are the caller's.
v1::FloorMap to_bus(const Map& map);

}  // namespace saphira::maps
