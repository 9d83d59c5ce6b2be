#include "saphira/maps/zones.hpp"

#include <algorithm>

namespace saphira::maps {
namespace {

constexpr std::string_view kBetween = "; ";

/// The parts of a text between "; ".
std::vector<std::string> parts(std::string_view text) {
  std::vector<std::string> found;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(kBetween), text.size());
    found.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + kBetween.size(), text.size()));
  }
  return found;
}

/// The speaker of "Charlie said ..."; people, where that is not told.
std::string speaker(const std::string& source) {
  const std::size_t said = source.find(" said ");
  return said == std::string::npos || said == 0 ? "people" : source.substr(0, said);
}

Zone advised(const std::string& kind, const std::string& place, const std::string& who) {
  Zone zone;
  const std::optional<ZoneRule> rule = zone_rule(kind);
  if (rule == ZoneRule::keep_out) {
    zone.text = place + ", which " + who + " told me to keep out of";
    zone.inside = "is in a place that " + who + " told me to keep out of";
  } else if (rule == ZoneRule::slow) {
    zone.rule = ZoneRule::slow;
    zone.text = place + ", where " + who + " told me to go slowly";
  } else if (rule == ZoneRule::preferred) {
    zone.rule = ZoneRule::preferred;
    zone.text = place + ", which " + who + " told me to prefer";
  } else {
    // On a slippery floor the robot drives, but slowly.
    if (kind == "wet floor" || kind == "slippery floor")
      zone.rule = ZoneRule::slow;
    zone.text = kind + " at " + place;
    zone.inside = "is where people warn of: " + zone.text;
  }
  if (zone.rule == ZoneRule::slow)
    zone.speed = kSlowly;
  return zone;
}

void add_zones_of(const Map& map, std::vector<Zone>& zones) {
  for (const Feature& feature : map.features) {
    if (feature.type != lps::PointType::zone)
      continue;
    Zone zone;
    zone.rule = feature.rule;
    zone.speed = feature.speed;
    zone.text = std::string(word(feature.rule)) + " zone " +
                (feature.name.empty() ? std::to_string(feature.id) : '"' + feature.name + '"');
    zone.inside = "is in " + zone.text;
    zone.area = feature;
    zones.push_back(std::move(zone));
  }
}

void add_advised(const Topology& topology, std::string_view hazards, std::string_view said_by,
                 std::vector<Zone>& zones) {
  const std::vector<std::string> all = parts(hazards);
  const std::vector<std::string> sources = parts(said_by);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t at = all[i].find(" at ");
    if (at == std::string::npos)
      continue;
    const std::string place = all[i].substr(at + 4);
    const auto named = topology.place(place);
    if (!named)
      continue;
    // A quoted sentence may hold the mark between two: then the sources are not told apart.
    Zone zone = advised(all[i].substr(0, at), place,
                        sources.size() == all.size() ? speaker(sources[i]) : "people");
    zone.regions = named->regions;
    zones.push_back(std::move(zone));
  }
}

}  // namespace

bool Zone::covers(std::size_t region) const {
  return std::find(regions.begin(), regions.end(), region) != regions.end();
}

bool Zone::contains(const Topology& topology, const Vec2& position_in_map, double margin) const {
  if (area)
    return distance_to(*area, position_in_map) <= margin;
  const auto region = topology.region_at(position_in_map, margin);
  return region && covers(*region);
}

std::vector<Zone> all_zones(const Map& map, const Topology& topology, std::string_view hazards,
                            std::string_view said_by) {
  std::vector<Zone> zones;
  add_zones_of(map, zones);
  add_advised(topology, hazards, said_by, zones);
  return zones;
}

const Zone* zone_at(const std::vector<Zone>& zones, ZoneRule rule, const Topology& topology,
                    const Vec2& position_in_map) {
  const auto found = std::find_if(zones.begin(), zones.end(), [&](const Zone& zone) {
    return zone.rule == rule && zone.contains(topology, position_in_map);
  });
  return found == zones.end() ? nullptr : &*found;
}

const Zone* slowest_at(const std::vector<Zone>& zones, const Topology& topology,
                       const Vec2& position_in_map, double radius) {
  const Zone* slowest = nullptr;
  for (const Zone& zone : zones)
    if (zone.rule == ZoneRule::slow && (slowest == nullptr || zone.speed < slowest->speed) &&
        zone.contains(topology, position_in_map, radius))
      slowest = &zone;
  return slowest;
}

}  // namespace saphira::maps
