#include "maps/shell/convert.hpp"

#include "lps/shell/convert.hpp"

namespace saphira::maps {

Feature from_bus(const v1::MapArtifact& artifact) {
  return translated<Feature>(artifact);
}

v1::MapArtifact to_bus(const Feature& feature) {
  return translated<v1::MapArtifact>(feature);
}

Map from_bus(const v1::FloorMap& map) {
  return {translated<std::vector<Feature>>(map.artifacts)};
}

v1::FloorMap to_bus(const Map& map) {
  return {.artifacts = translated<std::vector<v1::MapArtifact>>(map.features)};
}

}  // namespace saphira::maps
