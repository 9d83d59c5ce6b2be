#include "zones.hpp"

#include <algorithm>
#include <cmath>

#include "on_map.hpp"
#include "saphira/base/age.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/maps/route.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::intentions {
namespace {

constexpr double kAhead = 1.5;        ///< [m] beyond its hull that a slow robot looks ahead
constexpr double kProbe = 0.05;       ///< [m]
constexpr double kReaction = 0.3;     ///< [s] until the robot brakes
constexpr double kBrakesSo = 0.3;     ///< [m/s2] of a robot that does not tell it
constexpr double kStandstill = 0.05;  ///< [m/s] too slow to go on

/// A keep-out before the robot, and the speed from which the robot stops before it.
struct Ahead {
  std::string text;  ///< empty: none
  double speed = 0.0;
};

Ahead look_ahead(const World& world, const std::vector<maps::Zone>& zones, bool backwards) {
  Ahead ahead;
  const std::optional<Pose> robot = world.robot_in_map();
  if (!robot || world.around.topology == nullptr)
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

std::vector<maps::Zone> zones_of(const World& world) {
  std::vector<maps::Zone> zones;
  if (world.around.map != nullptr)
    zones = maps::zones_of(*world.around.map);
  const Belief* const belief = world.beliefs.stored(kHazards);
  const std::string* const text = belief == nullptr ? nullptr : belief->value.text();
  if (text != nullptr && world.around.topology != nullptr)
    for (maps::Zone& zone : maps::advised_zones(*world.around.topology, *text, belief->said_by))
      zones.push_back(std::move(zone));
  return zones;
}

std::string why_kept_out(const World& world, const Pose& point, Frame frame) {
  const auto at = in_frame(point, frame, Frame::map, world.robot);
  if (!at || world.around.topology == nullptr)
    return {};
  const std::vector<maps::Zone> zones = zones_of(world);
  const maps::Zone* const zone =
      maps::zone_at(zones, maps::ZoneRule::keep_out, *world.around.topology, at->position());
  return zone == nullptr ? std::string() : zone->inside;
}

std::string keep_out_ahead(const World& world, bool backwards) {
  const Ahead ahead = look_ahead(world, zones_of(world), backwards);
  return ahead.speed == 0.0 ? ahead.text : std::string();
}

SpeedLimit speed_limit(const World& world, bool backwards) {
  SpeedLimit limit;
  const std::optional<Pose> robot = world.robot_in_map();
  const std::vector<maps::Zone> zones = zones_of(world);
  if (zones.empty() || !robot || world.around.topology == nullptr)
    return limit;
  if (const maps::Zone* const slow =
          maps::slowest_at(zones, *world.around.topology, robot->position()))
    limit = {slow->speed, slow->text};
  const Ahead ahead = look_ahead(world, zones, backwards);
  if (!ahead.text.empty() && (limit.speed < 0.0 || ahead.speed < limit.speed))
    limit = {ahead.speed, ahead.text + (backwards ? " is behind it" : " is ahead")};
  return limit;
}

}  // namespace saphira::intentions
