#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/maps/topology.hpp"

namespace saphira::maps {

/// The belief with the zones by advice.
inline constexpr const char* kHazards = "hazards";

/// [m/s] By advice to go slowly, which gives no speed.
inline constexpr double kSlowly = 0.15;

/// A rule for a part of the floor: of the map, or by advice.
struct Zone {
  ZoneRule rule = ZoneRule::keep_out;
  double speed = 0.0;  ///< [m/s] of slow
  std::string text;    ///< for people: keep-out zone "lab"; lab, where Charlie told me to go slowly
  std::string inside;  ///< says of a place that it lies there: is in keep-out zone "lab"
  // Where: a rectangle, or the whole of some regions.
  std::optional<Feature> area;
  std::vector<std::size_t> regions;

  /// True where a position lies in it, or no more than `margin` [m] beside it.
  bool contains(const Topology& topology, const Vec2& position_in_map, double margin = 0.0) const;
  bool covers(std::size_t region) const;
};

/// The zones of a map, and those by advice: the belief kHazards, such as "water leak at upper
/// corridor; slow at lab; keep-out at EJ-231; preferred at central corridor". `said_by` names the
/// speaker of each, in the same order: "Charlie said ...; ...". Places that the topology does not
/// have are left out.
std::vector<Zone> all_zones(const Map& map, const Topology& topology, std::string_view hazards = {},
                            std::string_view said_by = {});

/// The first zone with that rule that holds at a position; nullptr: none.
const Zone* zone_at(const std::vector<Zone>& zones, ZoneRule rule, const Topology& topology,
                    const Vec2& position_in_map);

/// The slowest slow zone that a circle of that radius [m] around a position reaches; nullptr: none.
const Zone* slowest_at(const std::vector<Zone>& zones, const Topology& topology,
                       const Vec2& position_in_map, double radius);

}  // namespace saphira::maps
