#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/intentions/functions.hpp"

namespace saphira::intentions {

/// The functions for navigation of activities: regions, doors and paths of the map, corridors and
/// doors of the LPS, obstacles. The table is in the README.
///
/// A path is a list: region, way out, region, ..., region, and a point where the place has one. It
/// is valid for one revision of the map. Ways that proved closed are in the environment variable
/// *closed-ways*; `find-path` avoids them for five minutes. It also keeps the
/// rules of the zones of the map, and of those in the belief `hazards`, by advice.
void add_navigation(Functions& functions);

/// The points of the rest of a path [m] [map]: its ways out and its end. Empty for another revision
/// of the map.
std::vector<Vec2> way_points(const Surroundings& around, const Value& path);

/// The speed that zones of the map, advice, and an order to go slowly allow the robot at its place.
struct SpeedLimit {
  double speed = -1.0;  ///< [m/s]; below 0: none
  std::string reason;   ///< in words; empty: none
};
/// Of the slow zones around the robot, of a keep-out before it, where it drives to, and of the
/// belief `pace`, which may be "slow".
SpeedLimit speed_limit(const World& world, bool backwards);

/// The reason why a goal is not taken up: it leads to a point of the map where no goal may lead, in
/// a keep-out or outside of the map's rooms and corridors. Empty: it may be.
std::string why_refused(const World& world, std::string_view functor, const Arguments& arguments);

/// core_functions() and these: all functions of the shipped activities.
std::shared_ptr<const Functions> all_functions();

}  // namespace saphira::intentions
