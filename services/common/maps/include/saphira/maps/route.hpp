#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/maps/topology.hpp"
#include "saphira/maps/zones.hpp"

namespace saphira::maps {

/// The way through one region. Paths in Saphira are sequences of regions; the behaviors choose the
/// exact way within a region (paper 3.4).
struct Leg {
  std::size_t region = 0;
  std::optional<std::size_t> link;  ///< the way out of it; none in the last one
  /// The points to drive through, in the map, up to and including the way out: along the middle of
  /// a corridor, and straight through a door. Never empty.
  std::vector<Vec2> points;

  bool operator==(const Leg&) const = default;
};

struct Route {
  std::vector<Leg> legs;
  double length = 0.0;  ///< [m] from point to point

  /// The points of all legs.
  std::vector<Vec2> points() const;
};

/// [m] The guard's margin on each side of the robot (bridge/authority, GuardSettings::side_margin).
inline constexpr double kBeside = 0.08;

/// [m] Between two posts or walls a robot, a circle of this radius [m], needs its diameter and that
/// margin on each side.
inline double needed_width(double radius) {
  return 2.0 * (radius + kBeside);
}

struct RouteSettings {
  std::set<std::uint32_t> blocked;      ///< ids of forbidden doors, breaks and regions
  std::set<std::size_t> blocked_links;  ///< by index: also links without an id
  /// Ids of doors that were closed when last seen: used only where any other way is longer by
  /// `closed_costs`.
  std::set<std::uint32_t> closed;
  double closed_costs = 50.0;  ///< [m]
  /// [m] The robot's width between two posts or walls: narrower doors, openings and corridors are
  /// not used. 0: any width.
  double needs_width = 0.0;
  /// A way does not enter a keep-out, nor go against a one-way zone; the robot may leave the
  /// keep-outs around its start. Its stretches in slow zones count as longer, in preferred ones as
  /// half as long.
  std::vector<Zone> zones;
  double cruise = 0.3;          ///< [m/s] speed elsewhere
  double door_clearance = 0.7;  ///< [m] way in line before and behind a door
  double tolerance = 0.5;       ///< [m] tolerated distance of the robot from its region
};

/// A route, or the reason why there is none, in words.
struct RouteResult {
  std::optional<Route> route;
  std::string reason;
  // The zones that matter, in words.
  std::vector<std::string> out_of{};   ///< keep-outs in which the robot stands
  std::vector<std::string> around{};   ///< without them another way would be shorter
  std::vector<std::string> through{};  ///< slow or preferred zones on the way

  /// "out of keep-out zone "hall", and around keep-out zone "lab""; empty: no zone matters.
  std::string remark() const;
};

/// The shortest way from the robot's position to a place (Topology::place), by the lengths of the
/// stretches between the ways out. A place without a point of its own, a room or a corridor, is
/// reached as soon as the robot is inside.
RouteResult find_route(const Topology& topology, const Vec2& from_in_map,
                       std::string_view to_name_or_id, const RouteSettings& settings = {});
RouteResult find_route(const Topology& topology, const Vec2& from_in_map, const Place& to,
                       const RouteSettings& settings = {});
/// To a position.
RouteResult find_route(const Topology& topology, const Vec2& from_in_map, const Vec2& to_in_map,
                       const RouteSettings& settings = {});

/// The zone that forbids a way from a position on; empty: none. The legs need no points: they are
/// found anew. `end`: the last point of the way. The last leg counts even where it began in the
/// zone.
std::string forbidden(const Topology& topology, const Vec2& from_in_map,
                      const std::vector<Leg>& legs, const std::optional<Vec2>& end,
                      const RouteSettings& settings);

/// "corridor 2, junction 12, corridor 3, door 1265, room 265 (EJ-265)".
std::string text(const Topology& topology, const Route& route);

}  // namespace saphira::maps
