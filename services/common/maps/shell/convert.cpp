#include "maps/shell/convert.hpp"

#include "lps/shell/convert.hpp"
#include "saphira/base/enum_pairs.hpp"

namespace saphira::maps {
namespace {

constexpr auto kRules = pairs_by_name<ZoneRule, v1::ZoneRule>();

}  // namespace

Feature from_bus(const v1::MapArtifact& artifact) {
  Feature feature;
  feature.type = lps::from_bus(artifact.type);
  feature.id = artifact.id;
  feature.pose_in_map = lps::from_bus(artifact.pose_in_map);
  feature.length = artifact.length;
  feature.width = artifact.width;
  feature.name = artifact.name;
  feature.learned = artifact.learned;
  feature.rule = kRules.ours(artifact.rule, ZoneRule::keep_out);
  feature.speed = artifact.speed;
  return feature;
}

v1::MapArtifact to_bus(const Feature& feature) {
  return {.id = feature.id,
          .type = lps::to_bus(feature.type),
          .pose_in_map = lps::to_bus(feature.pose_in_map),
          .length = feature.length,
          .width = feature.width,
          .name = feature.name,
          .learned = feature.learned,
          .rule = kRules.theirs(feature.rule),
          .speed = feature.speed};
}

Map from_bus(const v1::FloorMap& map) {
  Map result;
  result.features = converted(map.artifacts, [](const auto& each) { return from_bus(each); });
  return result;
}

v1::FloorMap to_bus(const Map& map) {
  return {.artifacts = converted(map.features, [](const auto& each) { return to_bus(each); })};
}

}  // namespace saphira::maps
