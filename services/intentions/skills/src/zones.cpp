#include "zones.hpp"

#include <algorithm>
#include <cmath>

#include "driving.hpp"
#include "saphira/base/age.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/maps/route.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::intentions {

/// Zones, and what they were made of.
struct KnownZones {
  std::shared_ptr<const maps::Map> map;
  std::uint64_t beliefs = 0;  ///< their revision
  std::vector<maps::Zone> zones;
};

namespace {

constexpr double kAhead = 1.5;        ///< [m] beyond its hull that a slow robot looks ahead
constexpr double kProbe = 0.05;       ///< [m]
constexpr double kReaction = 0.3;     ///< [s] until the robot brakes
constexpr double kBrakesSo = 0.3;     ///< [m/s2] of a robot that does not tell it
constexpr double kSlowPace = 0.15;    ///< [m/s] of a robot that was told to go slowly
constexpr double kStandstill = 0.05;  ///< [m/s] too slow to go on

/// A keep-out before the robot, and the speed from which the robot stops before it.
struct Ahead {
  std::string text;  ///< empty: none
  double speed = 0.0;
};

Ahead look_ahead(const World& world, bool backwards) {
  Ahead ahead;
  const std::optional<Pose> robot = world.robot_in_map();
  const std::vector<maps::Zone>& zones = zones_of(world);
  if (!robot || zones.empty())
    return ahead;
  const maps::Topology& map = *world.around.topology;
  const double side = backwards ? -1.0 : 1.0;
  const double radius = world.around.robot_radius;
  const double brakes = world.around.deceleration > 0.0 ? world.around.deceleration : kBrakesSo;
  const double speed = world.robot.velocity;
  double free = std::max(kAhead, speed * speed / (2.0 * brakes) + std::abs(speed) * kReaction);
  for (const maps::Zone& zone : zones) {
    // The robot may leave a keep-out.
    if (zone.rule != maps::ZoneRule::keep_out || zone.contains(map, robot->position()))
      continue;
    // The hull counts at its sides, too, unless it is beside the zone already.
    const bool beside = zone.area && !zone.contains(map, robot->position(), radius);
    const double before = (beside ? 0.0 : radius) + maps::kBeside;
    for (double way = kProbe; way < before + free; way += kProbe)
      if (zone.contains(map, transform(*robot, {side * way, 0.0}), beside ? radius : 0.0)) {
        ahead.text = zone.text;
        free = std::max(0.0, way - before);
        break;
      }
  }
  if (!ahead.text.empty()) {
    const double allowed = speed_that_stops(free, kReaction, brakes);
    ahead.speed = allowed < kStandstill ? 0.0 : allowed;
  }
  return ahead;
}

}  // namespace

const std::vector<maps::Zone>& zones_of(const World& world) {
  static const std::vector<maps::Zone> kNone;
  const Surroundings& around = world.around;
  if (around.map == nullptr || around.topology == nullptr)
    return kNone;
  const std::uint64_t beliefs = world.beliefs.revision();
  if (around.zones == nullptr || around.zones->map != around.map ||
      around.zones->beliefs != beliefs) {
    const Belief* const belief = world.beliefs.stored(maps::kHazards);
    const std::string* const text = belief == nullptr ? nullptr : belief->value.text();
    around.zones = std::make_shared<const KnownZones>(KnownZones{
        around.map, beliefs,
        text == nullptr ? maps::all_zones(*around.map, *around.topology)
                        : maps::all_zones(*around.map, *around.topology, *text, belief->said_by)});
  }
  return around.zones->zones;
}

std::string why_no_goal(const World& world, const Pose& point, Frame frame) {
  const maps::Topology* const map = world.around.topology.get();
  const auto at = in_frame(point, frame, Frame::map, world.robot);
  if (!at || map == nullptr)
    return {};
  if (const maps::Zone* const zone =
          maps::zone_at(zones_of(world), maps::ZoneRule::keep_out, *map, at->position()))
    return zone->inside;
  const bool outside = frame == Frame::map && !map->regions().empty() &&
                       map->at(at->position()).empty() &&
                       !map->region_at(at->position(), maps::RouteSettings().tolerance);
  return outside ? "is in no room or corridor of the map" : "";
}

std::string why_refused(const World& world, std::string_view functor, const Arguments& arguments) {
  if (functor != "go_to" && functor != "go-to-place")
    return {};
  for (const Argument& to : arguments)
    if (to.kind == ArgumentKind::point && to.frame == Frame::map)
      if (const std::string why = why_no_goal(world, to.point, to.frame); !why.empty())
        return format_point(to) + " " + why;
  return {};
}

std::string keep_out_ahead(const World& world, bool backwards) {
  const Ahead ahead = look_ahead(world, backwards);
  return ahead.speed == 0.0 ? ahead.text : std::string();
}

SpeedLimit speed_limit(const World& world, bool backwards) {
  SpeedLimit limit;
  if (world.beliefs.get("pace", world) == Value("slow"))
    limit = {kSlowPace, "told to go slowly"};
  const std::optional<Pose> robot = world.robot_in_map();
  const std::vector<maps::Zone>& zones = zones_of(world);
  if (zones.empty() || !robot)
    return limit;
  if (const maps::Zone* const slow = maps::slowest_at(zones, *world.around.topology,
                                                      robot->position(), world.around.robot_radius);
      slow != nullptr && (limit.speed < 0.0 || slow->speed < limit.speed))
    limit = {slow->speed, slow->text};
  const Ahead ahead = look_ahead(world, backwards);
  if (!ahead.text.empty() && (limit.speed < 0.0 || ahead.speed < limit.speed))
    limit = {ahead.speed, ahead.text + (backwards ? " is behind it" : " is ahead")};
  return limit;
}

}  // namespace saphira::intentions
