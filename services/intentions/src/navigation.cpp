#include "saphira/intentions/navigation.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mapping.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/lps/percept.hpp"
#include "saphira/maps/route.hpp"
#include "saphira/maps/topology.hpp"
#include "seeing.hpp"

namespace saphira::intentions {
namespace {

using lps::PointType;
using maps::LinkKind;
using maps::RegionKind;
using Kind = Reference::Kind;

constexpr double kForget = 300.0;   ///< [s] after which a closed way may be open again
constexpr double kAstray = 0.5;     ///< [m] outside of its region the robot may believe to be
constexpr double kSameDoor = 0.5;   ///< [m] a door that is seen and one on the map are the same
constexpr double kBody = 0.30;      ///< [m] half of what has to be free before the robot
constexpr double kNear = 1.6;       ///< [m] from where on the sonars tell a closed door
constexpr double kSeenAgain = 3.0;  ///< [s] what was seen longer ago counts no more
constexpr double kThere = 0.4;      ///< [m] so near to its point the robot is at a place
constexpr double kVisited = 1.5;    ///< [m] around where the robot has been
constexpr double kDeep = 0.2;       ///< [m] before and behind a doorway, what stands in it
constexpr double kStep = 0.7;       ///< [m] a nearer point is not worth driving to
constexpr double kWayIn = 1.0;      ///< [m] behind a door where a room has been visited

const char* const kClosedWays = "*closed-ways*";

double seconds(const World& world) {
  return static_cast<double>(world.now) * kTick;
}

const maps::Topology& map_of(const World& world, std::string_view function) {
  if (world.around.topology == nullptr)
    throw ActivityError(std::string(function) + ": there is no map", GoalCode::kNoRoute);
  return *world.around.topology;
}

const Reference& reference_of(Values arguments, std::size_t index, std::string_view function) {
  const Reference* const reference = arguments[index].reference();
  if (reference == nullptr)
    throw ActivityError(std::string(function) +
                        ": expected something on the map or that is seen, found " +
                        kind_of(arguments[index]));
  return *reference;
}

[[noreturn]] void stale(std::string_view function) {
  throw ActivityError(std::string(function) + ": the map has changed since");
}

bool current(const World& world, const Reference& reference) {
  return reference.revision == world.around.map_revision && world.around.topology != nullptr;
}

std::size_t region_index(const World& world, const Reference& reference,
                         std::string_view function) {
  if (reference.kind != Kind::kRegion)
    throw ActivityError(std::string(function) + ": expected a region");
  if (!current(world, reference) || reference.id >= world.around.topology->regions().size())
    stale(function);
  return reference.id;
}

std::size_t link_index(const World& world, const Reference& reference, std::string_view function) {
  if (reference.kind != Kind::kLink)
    throw ActivityError(std::string(function) + ": expected a door or another way out");
  if (!current(world, reference) || reference.id >= world.around.topology->links().size())
    stale(function);
  return reference.id;
}

const maps::Region& region_of(const World& world, Values arguments, std::size_t index,
                              std::string_view function) {
  return world.around.topology
      ->regions()[region_index(world, reference_of(arguments, index, function), function)];
}

const maps::Link& link_of(const World& world, Values arguments, std::size_t index,
                          std::string_view function) {
  return world.around.topology
      ->links()[link_index(world, reference_of(arguments, index, function), function)];
}

Value region_value(const World& world, std::size_t index) {
  return Value(Reference{Kind::kRegion, index, world.around.map_revision});
}

Value link_value(const World& world, std::size_t index) {
  return Value(Reference{Kind::kLink, index, world.around.map_revision});
}

Value on_map(const Pose& pose) {
  return Value(Point{pose, Frame::kMap});
}

Value on_map(const Vec2& position, double heading = 0.0) {
  return on_map(Pose{position.x(), position.y(), heading});
}

/// A point as the robot sees it; none while the way there goes over a map on which the robot is
/// not.
std::optional<Pose> in_robot(const World& world, const Point& point) {
  return in_frame(point.pose, point.frame, Frame::kRobot, world.robot);
}

const lps::Percept* percept(const World& world, std::uint64_t id) {
  if (world.around.percepts != nullptr)
    for (const lps::Percept& each : *world.around.percepts)
      if (each.id == id)
        return &each;
  return nullptr;
}

/// Where something is: a point is itself; regions and ways out by the map; percepts in odom.
std::optional<Point> place_of(const World& world, const Value& value) {
  if (const Point* const point = value.point())
    return *point;
  const Reference* const reference = value.reference();
  if (reference == nullptr)
    return std::nullopt;
  if (reference->kind == Kind::kPercept) {
    const lps::Percept* const seen = percept(world, reference->id);
    return seen == nullptr ? std::nullopt : std::optional(Point{seen->pose_in_odom, Frame::kOdom});
  }
  if (reference->kind == Kind::kThing) {
    const lps::SeenThing* const seen = seen_thing(world, reference->id);
    return seen == nullptr ? std::nullopt : std::optional(Point{seen->pose_in_odom, Frame::kOdom});
  }
  if (!current(world, *reference))
    return std::nullopt;
  const maps::Topology& map = *world.around.topology;
  if (reference->kind == Kind::kRegion && reference->id < map.regions().size())
    return Point{map.regions()[reference->id].area.pose_in_map, Frame::kMap};
  if (reference->kind == Kind::kLink && reference->id < map.links().size())
    return Point{map.links()[reference->id].pose_in_map, Frame::kMap};
  return std::nullopt;
}

Point point_at(const World& world, Values arguments, std::size_t index, std::string_view function) {
  const std::optional<Point> point = place_of(world, arguments[index]);
  if (!point)
    throw ActivityError(std::string(function) +
                        ": expected a point or something that has a place, found " +
                        to_text(arguments[index]));
  return *point;
}

std::optional<std::size_t> region_here(const World& world) {
  const std::optional<Pose> robot = world.robot_in_map();
  if (!robot || world.around.topology == nullptr)
    return std::nullopt;
  return world.around.topology->region_at(robot->position(), kAstray);
}

// ---- Names

/// What a person or an activity means by a place.
std::optional<maps::Place> place_named(const maps::Topology& map, const Value& value) {
  if (const std::string* const name = value.text())
    return map.place(*name);
  if (const double* const number = value.number()) {
    char text[24];
    const auto end = std::to_chars(text, text + sizeof text, static_cast<std::int64_t>(*number));
    return map.place({text, static_cast<std::size_t>(end.ptr - text)});
  }
  return std::nullopt;
}

}  // namespace

std::string name_of(const World& world, const Value& value) {
  const Reference* const reference = value.reference();
  if (reference != nullptr && current(world, *reference)) {
    const maps::Topology& map = *world.around.topology;
    if (reference->kind == Kind::kRegion && reference->id < map.regions().size())
      return map.text(reference->id);
    if (reference->kind == Kind::kLink && reference->id < map.links().size()) {
      const maps::Link& link = map.links()[reference->id];
      if (link.kind == LinkKind::meeting)
        return "the way into " + map.text(link.b.value_or(link.a));
      std::string name =
          (link.kind == LinkKind::door ? "door " : "opening ") + std::to_string(link.id);
      if (link.b && !map.regions()[*link.b].area.name.empty())
        name += " (" + map.regions()[*link.b].area.name + ")";
      return name;
    }
  }
  return spoken(value);
}

namespace {

// ---- Paths

std::vector<std::pair<Reference, double>> closed_ways(const Value& value) {
  std::vector<std::pair<Reference, double>> ways;
  for (const Value& each : value.list()) {
    const Value::List& entry = each.list();
    if (entry.size() == 2 && entry[0].reference() != nullptr && entry[1].number() != nullptr)
      ways.emplace_back(*entry[0].reference(), *entry[1].number());
  }
  return ways;
}

maps::RouteSettings route_settings(const World& world) {
  maps::RouteSettings settings;
  settings.tolerance = kAstray;
  settings.closed = world.around.registration.closed_doors;
  for (const auto& [way, since] : closed_ways(world.beliefs.get(kClosedWays, world))) {
    if (!current(world, way) || seconds(world) - since >= kForget)
      continue;
    if (way.kind == Kind::kLink)
      settings.blocked_links.insert(way.id);
    else if (way.kind == Kind::kRegion && way.id < world.around.topology->regions().size())
      settings.blocked.insert(world.around.topology->regions()[way.id].area.id);
  }
  return settings;
}

maps::RouteResult route(const World& world, const Value& from, const Value& to) {
  const maps::Topology& map = map_of(world, "find-path");
  std::optional<Vec2> start;
  if (const std::optional<Pose> robot = world.robot_in_map())
    start = robot->position();
  // From elsewhere than where the robot is.
  if (const Reference* const region = from.reference()) {
    const bool here = start && region->kind == Kind::kRegion && current(world, *region) &&
                      region->id < map.regions().size() &&
                      maps::distance_to(map.regions()[region->id].area, *start) <= kAstray;
    const std::optional<Point> point = here ? std::nullopt : place_of(world, from);
    if (point && point->frame == Frame::kMap)
      start = point->pose.position();
  } else if (from.point() != nullptr) {
    const auto point = in_frame(from.point()->pose, from.point()->frame, Frame::kMap, world.robot);
    start = point ? std::optional(point->position()) : std::nullopt;
  }
  if (!start)
    return {std::nullopt, "the robot does not know where it is on the map"};
  const maps::RouteSettings settings = route_settings(world);
  if (const Reference* const region = to.reference()) {
    maps::Place place;
    place.name = name_of(world, to);
    if (region->kind == Kind::kRegion && current(world, *region))
      place.regions = {region->id};
    return maps::find_route(map, *start, place, settings);
  }
  if (to.point() != nullptr) {
    const auto goal = in_frame(to.point()->pose, to.point()->frame, Frame::kMap, world.robot);
    if (!goal)
      return {std::nullopt, "the robot does not know where it is on the map"};
    return maps::find_route(map, *start, goal->position(), settings);
  }
  const std::optional<maps::Place> place = place_named(map, to);
  if (!place)
    return {std::nullopt, "the map has no place \"" + spoken(to) + "\""};
  return maps::find_route(map, *start, *place, settings);
}

Value path_of(const World& world, const maps::Route& route, const Value& to) {
  Value::List path;
  for (const maps::Leg& leg : route.legs) {
    path.push_back(region_value(world, leg.region));
    if (leg.link)
      path.push_back(link_value(world, *leg.link));
  }
  std::optional<Vec2> end;
  if (to.point() != nullptr) {
    if (const auto goal = in_frame(to.point()->pose, to.point()->frame, Frame::kMap, world.robot))
      end = goal->position();
  } else if (to.reference() == nullptr) {
    if (const auto place = place_named(*world.around.topology, to))
      end = place->point;
  }
  if (end)
    path.push_back(on_map(*end));
  return Value(std::move(path));
}

/// What is to be done with the beginning of a path, for follow-path to choose by: the name of a
/// schema, or done.
Value leg_of(const World& world, Values arguments) {
  const Value::List& path = arguments[0].list();
  if (path.empty())
    return "done";
  const maps::Topology& map = map_of(world, "leg");
  const Reference* const first = path[0].reference();
  if (first == nullptr)
    return "to-point";
  const maps::Region& region = map.regions()[region_index(world, *first, "leg")];
  const Reference* const out = path.size() > 1 ? path[1].reference() : nullptr;
  if (out == nullptr)
    return path.size() == 1                      ? "done"
           : region.kind == RegionKind::corridor ? "corridor-to-point"
                                                 : "to-point";
  const maps::Link& link = map.links()[link_index(world, *out, "leg")];
  if (link.kind != LinkKind::meeting)
    return region.kind == RegionKind::corridor ? "corridor-to-door" : "room-to-door";
  if (region.kind == RegionKind::junction)
    return "on";
  return region.kind == RegionKind::corridor ? "corridor-to-junction" : "cross-region";
}

// ---- Regions and doors

/// The middle line of a corridor as a directed point, towards a way out of it or a point.
Pose lane(const maps::Feature& area, const Vec2& towards) {
  Pose pose = area.pose_in_map;
  const Vec2 to = maps::on_axis(area, towards);
  pose.th = to_frame(pose, to).x() >= 0.0 ? pose.th : norm2_angle(pose.th + kPi);
  return pose;
}

/// The door that is seen where the map has one: what is seen is where it is, relative to the robot.
const lps::Percept* seen_door(const World& world, const maps::Link& link) {
  if (world.around.percepts == nullptr || !world.robot.odom_in_map)
    return nullptr;
  const lps::Percept* best = nullptr;
  double nearest = kSameDoor;
  for (const lps::Percept& each : *world.around.percepts) {
    if (each.type != PointType::door)
      continue;
    const Pose in_map = compose(*world.robot.odom_in_map, each.pose_in_odom);
    const double off = (in_map.position() - link.pose_in_map.position()).norm();
    const double turned = std::abs(norm3_angle(in_map.th - link.pose_in_map.th));
    if (off < nearest && turned < radians(20.0) && std::abs(each.width - link.width) < 0.4) {
      nearest = off;
      best = &each;
    }
  }
  return best;
}

Value door_pose(const World& world, Values arguments) {
  const maps::Link& link = link_of(world, arguments, 0, "door-pose");
  const lps::Percept* const seen = seen_door(world, link);
  if (seen == nullptr)
    return on_map(link.pose_in_map);
  // The normal of the map's door: that of what is seen is towards where it was seen from.
  const Pose by_map = relative(*world.robot.odom_in_map, link.pose_in_map);
  Pose pose = seen->pose_in_odom;
  if (std::abs(norm2_angle(pose.th - by_map.th)) > kPi / 2)
    pose.th = norm2_angle(pose.th + kPi);
  return Value(Point{pose, Frame::kOdom});
}

/// The widest gap between what stands in the doorway [m], as the obstacle memory has it.
double widest_gap(const lps::LocalPerceptualSpace& lps, const Pose& door_in_robot, double width) {
  std::vector<double> at{-width / 2, width / 2};
  for (const Vec2& point : lps.obstacles()) {
    const Vec2 inside = to_frame(door_in_robot, point);
    if (std::abs(inside.x()) < kDeep && std::abs(inside.y()) < width / 2)
      at.push_back(inside.y());
  }
  std::sort(at.begin(), at.end());
  double widest = 0.0;
  for (std::size_t i = 1; i < at.size(); ++i)
    widest = std::max(widest, at[i] - at[i - 1]);
  return widest;
}

Value door_state(const World& world, Values arguments) {
  const maps::Link& link = link_of(world, arguments, 0, "door-state");
  const std::optional<Pose> door = in_robot(world, {link.pose_in_map, Frame::kMap});
  if (!door || world.around.lps == nullptr || link.kind == LinkKind::meeting)
    return "unknown";
  const double bearing = std::abs(std::atan2(door->y, door->x));
  const double far = std::hypot(door->x, door->y);
  if (far > kNear || bearing > radians(35.0)) {
    const lps::Percept* const seen = seen_door(world, link);
    const bool fresh = seen != nullptr && static_cast<double>(world.around.lps->cycle()) * kTick -
                                                  static_cast<double>(seen->seen) * kTick <
                                              kSeenAgain;
    return fresh ? "open" : "unknown";
  }
  return widest_gap(*world.around.lps, *door, link.width) < 2.0 * kBody - 0.1 ? "closed" : "open";
}

/// Which way through a door leads into a region: FollowDoor's direction. A door's normal is out
/// into its region a.
Value door_direction(const World& world, Values arguments) {
  const maps::Link& link = link_of(world, arguments, 0, "door-direction");
  const std::size_t into =
      region_index(world, reference_of(arguments, 1, "door-direction"), "door-direction");
  return link.a == into ? "out" : "in";
}

/// A point on the line through a door, so far on the side of a region.
Value before_door(const World& world, Values arguments) {
  const maps::Link& link = link_of(world, arguments, 0, "before-door");
  const std::size_t side =
      region_index(world, reference_of(arguments, 1, "before-door"), "before-door");
  const double far = arguments.size() > 2 ? number_of(arguments, 2, "before-door") : 0.7;
  const double sign = link.a == side ? 1.0 : -1.0;
  return on_map(transform(link.pose_in_map, {sign * far, 0.0}),
                norm2_angle(link.pose_in_map.th + (sign > 0.0 ? 0.0 : kPi)));
}

// ---- What is in the way

/// How far the robot can go straight on [m], at most as far as the LPS says anything.
double free_ahead(const World& world, double bearing) {
  double free = lps::kNothing;
  if (world.around.lps == nullptr)
    return free;
  for (const Vec2& point : world.around.lps->obstacles()) {
    const Vec2 turned = to_frame({0.0, 0.0, bearing}, point);
    if (turned.x() > 0.0 && std::abs(turned.y()) < kBody)
      free = std::min(free, turned.x());
  }
  return free;
}

/// The nearest percept of a type that satisfies `wanted`.
template <class Wanted>
const lps::Percept* nearest(const World& world, PointType type, Wanted&& wanted) {
  const lps::Percept* best = nullptr;
  double best_far = 1e9;
  if (world.around.percepts == nullptr)
    return nullptr;
  for (const lps::Percept& each : *world.around.percepts) {
    const Pose in = relative(world.robot.pose_in_odom, each.pose_in_odom);
    const double far = std::hypot(in.x, in.y);
    if (each.type == type && far < best_far && wanted(each, in)) {
      best = &each;
      best_far = far;
    }
  }
  return best;
}

Value seen_value(const lps::Percept* percept) {
  return percept == nullptr ? Value() : Value(Reference{Kind::kPercept, percept->id, 0});
}

/// The corridor that the robot is in: by registration, as current_environment of manual 8.1.2, or
/// else as it is seen.
Value corridor_here(const World& world) {
  const std::optional<Pose> robot = world.robot_in_map();
  if (robot && world.around.topology != nullptr) {
    const auto& regions = world.around.topology->regions();
    for (std::size_t i = 0; i < regions.size(); ++i)
      if (regions[i].kind == RegionKind::corridor &&
          maps::contains(regions[i].area, robot->position()))
        return region_value(world, i);
  }
  return seen_value(
      nearest(world, PointType::corridor, [](const lps::Percept& each, const Pose& in) {
        const Vec2 here = to_frame(in, {0.0, 0.0});
        return std::abs(here.x()) < each.length / 2 + 0.5 && std::abs(here.y()) < each.width / 2;
      }));
}

/// A corridor as a lane: on the map or seen.
struct Corridor {
  Point middle;
  double width = 0.0;
  double length = 0.0;
};

Corridor corridor_of(const World& world, Values arguments, std::size_t index,
                     std::string_view function) {
  const Reference& reference = reference_of(arguments, index, function);
  if (reference.kind == Kind::kPercept) {
    if (const lps::Percept* const seen = percept(world, reference.id))
      return {{seen->pose_in_odom, Frame::kOdom}, seen->width, seen->length};
    throw ActivityError(std::string(function) + ": it is no longer seen");
  }
  const maps::Feature& area =
      world.around.topology == nullptr
          ? throw ActivityError(std::string(function) + ": there is no map")
          : world.around.topology->regions()[region_index(world, reference, function)].area;
  return {{area.pose_in_map, Frame::kMap}, area.width, area.length};
}

// ---- Exploring

/// Every place that exploring ends at: the ends of corridors, and rooms behind their doors.
std::vector<Vec2> sights(const maps::Topology& map, bool rooms) {
  std::vector<Vec2> points;
  for (const maps::Region& region : map.regions()) {
    if (region.kind != RegionKind::corridor)
      continue;
    // As far from the end as from the walls.
    const double margin = std::min(region.area.width / 2, region.area.length / 2);
    for (const Vec2& end : {maps::begin_of(region.area), maps::end_of(region.area)})
      points.push_back(maps::on_axis(region.area, end, margin));
  }
  if (rooms)
    for (const maps::Link& link : map.links())
      if (link.kind == LinkKind::door && link.b && map.regions()[*link.b].kind == RegionKind::room)
        points.push_back(transform(link.pose_in_map, {-kWayIn, 0.0}));
  return points;
}

Value next_to_explore(const World& world, Values arguments) {
  const maps::Topology& map = map_of(world, "next-to-explore");
  const std::optional<Pose> robot = world.robot_in_map();
  if (!robot)
    return {};
  const bool rooms = arguments.size() > 1 && arguments[1].truthy();
  const maps::RouteSettings settings = route_settings(world);
  std::optional<Vec2> best;
  double shortest = 1e9;
  for (const Vec2& point : sights(map, rooms)) {
    bool been = (point - robot->position()).norm() < kVisited / 2;
    for (const Value& each : arguments[0].list())
      if (each.point() != nullptr)
        if (const auto at =
                in_frame(each.point()->pose, each.point()->frame, Frame::kMap, world.robot))
          been = been || (at->position() - point).norm() < kVisited;
    if (been)
      continue;
    const maps::RouteResult found = maps::find_route(map, robot->position(), point, settings);
    if (found.route && found.route->length < shortest) {
      shortest = found.route->length;
      best = point;
    }
  }
  return best ? on_map(*best) : Value();
}

/// Where to look for what registration knows: on the way to the nearest corridor, by its best guess
/// of where the robot is. In odom; nil where there is no guess.
Value way_to_corridor(const World& world, Values) {
  const Registered& guess = world.around.registration;
  if (world.around.topology == nullptr || guess.state == Localization::kNone ||
      guess.state == Localization::kUnplaced)
    return {};
  const maps::Topology& map = *world.around.topology;
  const Vec2 here = guess.pose_in_map.position();
  const maps::RouteSettings settings = route_settings(world);
  std::vector<Vec2> points;  // of the shortest way
  double shortest = 1e9;
  for (std::size_t i = 0; i < map.regions().size(); ++i) {
    if (map.regions()[i].kind != RegionKind::corridor)
      continue;
    maps::Place place;
    place.regions = {i};
    const Pose& middle = map.regions()[i].area.pose_in_map;
    place.point = maps::on_axis(map.regions()[i].area, here, 1.0);
    if ((*place.point - here).norm() < kStep)
      place.point = middle.position();
    const maps::RouteResult found = maps::find_route(map, here, place, settings);
    if (found.route && found.route->length < shortest) {
      shortest = found.route->length;
      points = found.route->points();
    }
  }
  for (const Vec2& point : points)
    if ((point - here).norm() > kStep) {
      const Vec2 seen = to_frame(guess.pose_in_map, point);
      return Value(
          Point{compose(world.robot.pose_in_odom, {seen.x(), seen.y(), 0.0}), Frame::kOdom});
    }
  return {};
}

Value yes(bool truth) {
  return Value::truth(truth);
}

void add_paths(Functions& functions) {
  functions.add(Function{"find-path", 2, 2,
                         [](const World& world, Values arguments) {
                           const maps::RouteResult found = route(world, arguments[0], arguments[1]);
                           return found.route ? path_of(world, *found.route, arguments[1])
                                              : Value();
                         },
                         "(find-path FROM TO): the regions and ways out to go through, or nil"});
  functions.add(Function{"why-no-path", 2, 2,
                         [](const World& world, Values arguments) {
                           return Value(route(world, arguments[0], arguments[1]).reason);
                         },
                         "(why-no-path FROM TO): the reason why find-path gives nil"});
  functions.add(Function{"way-length", 2, 2,
                         [](const World& world, Values arguments) {
                           const maps::RouteResult found = route(world, arguments[0], arguments[1]);
                           return found.route ? Value(found.route->length) : Value();
                         },
                         "(way-length FROM TO): of the way that find-path finds [m], or nil"});
  functions.add(Function{"path-current", 1, 1,
                         [](const World& world, Values arguments) {
                           for (const Value& each : arguments[0].list())
                             if (each.reference() != nullptr && !current(world, *each.reference()))
                               return Value();
                           return yes(true);
                         },
                         "(path-current PATH): whether the map is still the one that it is of"});
  functions.add(Function{"path-text", 1, 1,
                         [](const World& world, Values arguments) {
                           std::string text;
                           for (const Value& each : arguments[0].list()) {
                             const Reference* const way = each.reference();
                             if (way != nullptr && way->kind == Kind::kLink &&
                                 current(world, *way) &&
                                 world.around.topology->links()[way->id].kind == LinkKind::meeting)
                               continue;
                             text += (text.empty() ? "" : ", ") + name_of(world, each);
                           }
                           return Value(text);
                         },
                         "(path-text PATH): in words"});
  functions.add(Function{"leg", 1, 1, leg_of,
                         "(leg PATH): the name of the schema for its beginning, on, or done"});
  functions.add(Function{"closed-ways-with", 1, 1,
                         [](const World& world, Values arguments) {
                           const Reference& way = reference_of(arguments, 0, "closed-ways-with");
                           Value::List ways;
                           for (const auto& [each, since] :
                                closed_ways(world.beliefs.get(kClosedWays, world)))
                             if (!(each == way) && seconds(world) - since < kForget)
                               ways.push_back(Value(Value::List{Value(each), Value(since)}));
                           ways.push_back(Value(Value::List{Value(way), Value(seconds(world))}));
                           return Value(std::move(ways));
                         },
                         "(closed-ways-with WAY): *closed-ways* and that one, as of now"});
  functions.add(
      Function{"way-to-corridor", 0, 0, way_to_corridor,
               "(way-to-corridor): where to go to find out where it is, by the best guess"});
  functions.add(
      Function{"next-to-explore", 1, 2, next_to_explore,
               "(next-to-explore VISITED [ROOMS]): the nearest end of a corridor (and room) "
               "that is none of the points, or nil"});
}

/// Whether the robot is where a place is: within its region, and near its point where it has one.
bool at_place(const World& world, const Value& place) {
  const std::optional<Pose> robot = world.robot_in_map();
  if (!robot || world.around.topology == nullptr)
    return false;
  if (place.point() != nullptr) {
    const auto at = in_frame(place.point()->pose, place.point()->frame, Frame::kMap, world.robot);
    return at && (at->position() - robot->position()).norm() < kThere;
  }
  const auto meant = place_named(*world.around.topology, place);
  if (!meant)
    return false;
  if (meant->point)
    return (*meant->point - robot->position()).norm() < kThere;
  return std::any_of(meant->regions.begin(), meant->regions.end(), [&](std::size_t region) {
    return maps::contains(world.around.topology->regions()[region].area, robot->position());
  });
}

/// The words of a text, which commas or blanks separate.
Value split(const std::string& text) {
  Value::List words;
  std::string word;
  for (const char c : text + ",") {
    if (c != ',' && c != ' ') {
      word += c;
      continue;
    }
    if (!word.empty())
      words.emplace_back(word);
    word.clear();
  }
  return Value(std::move(words));
}

void add_places(Functions& functions) {
  functions.add(Function{
      "at-place", 1, 1,
      [](const World& world, Values arguments) { return yes(at_place(world, arguments[0])); },
      "(at-place PLACE): whether the robot is there"});
  functions.add(
      Function{"split", 1, 1,
               [](const World&, Values arguments) { return split(text_of(arguments, 0, "split")); },
               "(split TEXT): its words, between commas or blanks"});
  functions.add(Function{"room-p", 1, 1,
                         [](const World& world, Values arguments) {
                           const Reference* const reference = arguments[0].reference();
                           return yes(reference != nullptr && reference->kind == Kind::kRegion &&
                                      current(world, *reference) &&
                                      region_of(world, arguments, 0, "room-p").kind ==
                                          RegionKind::room);
                         },
                         "(room-p THING): whether it is a room of the map"});
  functions.add(Function{"link-p", 1, 1,
                         [](const World&, Values arguments) {
                           const Reference* const reference = arguments[0].reference();
                           return yes(reference != nullptr && reference->kind == Kind::kLink);
                         },
                         "(link-p THING): whether it is a door or another way out"});
  functions.add(Function{"place-known", 1, 1,
                         [](const World& world, Values arguments) {
                           return yes(world.around.topology != nullptr &&
                                      (arguments[0].point() != nullptr ||
                                       place_named(*world.around.topology, arguments[0])));
                         },
                         "(place-known NAME): whether the map has it"});
  functions.add(Function{
      "name-of", 1, 1,
      [](const World& world, Values arguments) { return Value(name_of(world, arguments[0])); },
      "(name-of THING): what it is called"});
  functions.add(Function{"region-at", 1, 1,
                         [](const World& world, Values arguments) {
                           const Point point = point_at(world, arguments, 0, "region-at");
                           const auto at =
                               in_frame(point.pose, point.frame, Frame::kMap, world.robot);
                           if (!at || world.around.topology == nullptr)
                             return Value();
                           const auto region =
                               world.around.topology->region_at(at->position(), kAstray);
                           return region ? region_value(world, *region) : Value();
                         },
                         "(region-at POINT): of the map, or nil"});
  functions.add(Function{"in-region", 1, 1,
                         [](const World& world, Values arguments) {
                           const maps::Region& region = region_of(world, arguments, 0, "in-region");
                           const std::optional<Pose> robot = world.robot_in_map();
                           return yes(robot && maps::contains(region.area, robot->position()));
                         },
                         "(in-region REGION): whether the robot is"});
  functions.add(Function{"place-of", 1, 1,
                         [](const World& world, Values arguments) {
                           return Value(point_at(world, arguments, 0, "place-of"));
                         },
                         "(place-of THING): its middle, directed, as a point"});
  functions.add(Function{"width-of", 1, 1,
                         [](const World& world, Values arguments) {
                           const Reference& reference = reference_of(arguments, 0, "width-of");
                           return Value(reference.kind == Kind::kLink
                                            ? link_of(world, arguments, 0, "width-of").width
                                            : corridor_of(world, arguments, 0, "width-of").width);
                         },
                         "(width-of THING): of a region, corridor or door [m]"});
  functions.add(Function{"length-of", 1, 1,
                         [](const World& world, Values arguments) {
                           return Value(corridor_of(world, arguments, 0, "length-of").length);
                         },
                         "(length-of THING): of a region or corridor [m]"});
  functions.add(Function{"here", 0, 0,
                         [](const World& world, Values) {
                           if (const auto robot = world.robot_in_map())
                             return on_map(*robot);
                           return Value(Point{world.robot.pose_in_odom, Frame::kOdom});
                         },
                         "(here): where the robot is: on the map, or else in odom"});
  functions.add(Function{"distance-to", 1, 1,
                         [](const World& world, Values arguments) {
                           const auto at =
                               in_robot(world, point_at(world, arguments, 0, "distance-to"));
                           return at ? Value(std::hypot(at->x, at->y)) : Value();
                         },
                         "(distance-to THING): from the robot to its middle [m]; nil if unknown"});
  functions.add(Function{"bearing-of", 1, 1,
                         [](const World& world, Values arguments) {
                           const auto at =
                               in_robot(world, point_at(world, arguments, 0, "bearing-of"));
                           return at ? Value(std::atan2(at->y, at->x)) : Value();
                         },
                         "(bearing-of THING): from the robot's heading [rad], left positive"});
  functions.add(Function{"distance-along", 2, 2,
                         [](const World& world, Values arguments) {
                           const auto lane_at =
                               in_robot(world, point_at(world, arguments, 0, "distance-along"));
                           const auto to =
                               in_robot(world, point_at(world, arguments, 1, "distance-along"));
                           if (!lane_at || !to)
                             return Value();
                           return Value(relative(*lane_at, *to).x - relative(*lane_at, Pose{}).x);
                         },
                         "(distance-along LANE THING): how far it is along the lane [m]"});
}

void add_corridors(Functions& functions) {
  functions.add(
      Function{"lane-of", 1, 2,
               [](const World& world, Values arguments) {
                 const Corridor corridor = corridor_of(world, arguments, 0, "lane-of");
                 Point middle = corridor.middle;
                 const auto seen = in_robot(world, middle);
                 const auto to = arguments.size() > 1
                                     ? in_robot(world, point_at(world, arguments, 1, "lane-of"))
                                     : std::nullopt;
                 if (!seen)
                   return Value(middle);
                 // As the robot goes, or towards the thing.
                 const bool back = to ? relative(*seen, *to).x < relative(*seen, Pose{}).x
                                      : std::abs(seen->th) > kPi / 2;
                 if (back)
                   middle.pose.th = norm2_angle(middle.pose.th + kPi);
                 return Value(middle);
               },
               "(lane-of CORRIDOR [THING]): its middle, directed as the robot is, or from "
               "the robot towards the thing"});
  functions.add(Function{"on-lane", 2, 2,
                         [](const World& world, Values arguments) {
                           const maps::Region& region = region_of(world, arguments, 0, "on-lane");
                           const Point point = point_at(world, arguments, 1, "on-lane");
                           const auto at =
                               in_frame(point.pose, point.frame, Frame::kMap, world.robot);
                           if (!at)
                             return Value();
                           const Vec2 on = maps::on_axis(region.area, at->position());
                           return on_map(on, lane(region.area, at->position()).th);
                         },
                         "(on-lane REGION THING): the nearest point on the middle line"});
  functions.add(Function{
      "aligned-in-lane", 4, 4,
      [](const World& world, Values arguments) {
        const auto lane_at = in_robot(world, point_at(world, arguments, 0, "aligned-in-lane"));
        const auto to = in_robot(world, point_at(world, arguments, 1, "aligned-in-lane"));
        if (!lane_at || !to)
          return Value();
        const double low = number_of(arguments, 2, "aligned-in-lane");
        const double high = number_of(arguments, 3, "aligned-in-lane");
        const bool on = relative(*lane_at, *to).x >= relative(*lane_at, Pose{}).x;
        const double off = std::abs(norm2_angle(lane_at->th + (on ? 0.0 : kPi)));
        return Value(std::clamp((high - off) / std::max(1e-9, high - low), 0.0, 1.0));
      },
      "(aligned-in-lane LANE TARGET LOW HIGH): 1 while the robot is turned off "
      "the way to the target by less than LOW [rad], 0 from HIGH on (manual 8.1.3)"});
  functions.add(Function{"lane-end", 1, 2,
                         [](const World& world, Values arguments) {
                           const Corridor corridor = corridor_of(world, arguments, 0, "lane-end");
                           const double margin =
                               arguments.size() > 1 ? number_of(arguments, 1, "lane-end") : 1.0;
                           Point middle = corridor.middle;
                           const auto seen = in_robot(world, middle);
                           if (!seen)
                             return Value();
                           if (std::abs(seen->th) > kPi / 2)
                             middle.pose.th = norm2_angle(middle.pose.th + kPi);
                           const double half = std::max(0.0, corridor.length / 2 - margin);
                           middle.pose = compose(middle.pose, {half, 0.0, 0.0});
                           return Value(middle);
                         },
                         "(lane-end CORRIDOR [MARGIN]): where it ends, as the robot is turned"});
  functions.add(Function{"door-pose", 1, 1, door_pose,
                         "(door-pose DOOR): as it is seen, or else by the map; directed out"});
  functions.add(Function{"door-state", 1, 1, door_state,
                         "(door-state DOOR): open, closed or unknown, as the sonars have it"});
  functions.add(Function{"door-direction", 2, 2, door_direction,
                         "(door-direction DOOR REGION): in or out, to get into the region"});
  functions.add(
      Function{"before-door", 2, 3, before_door,
               "(before-door DOOR REGION [M]): the point on its line on that side (0.7 m)"});
  functions.add(
      Function{"free-ahead", 0, 1,
               [](const World& world, Values arguments) {
                 return Value(free_ahead(
                     world, arguments.empty() ? 0.0 : number_of(arguments, 0, "free-ahead")));
               },
               "(free-ahead [RAD]): how far the robot could go in that direction [m]"});
  functions.add(Function{
      "seen", 1, 1,
      [](const World& world, Values arguments) {
        const std::string& what = text_of(arguments, 0, "seen");
        if (const std::optional<Value> thing = nearest_seen(world, what))
          return *thing;
        const PointType type = what == "door"       ? PointType::door
                               : what == "corridor" ? PointType::corridor
                               : what == "junction" ? PointType::junction
                               : what == "wall"     ? PointType::wall
                                                    : PointType::invalid;
        if (type == PointType::invalid)
          throw ActivityError(
              "seen: expected door, corridor, junction, wall, person, blob, blob-a, blob-b or "
              "blob-c, found " +
              what);
        return seen_value(nearest(world, type, [](const auto&, const auto&) { return true; }));
      },
      "(seen KIND): the nearest door, corridor, junction, wall, person, blob or blob-a to -c, "
      "or nil"});
}

void add_conditions(Functions& functions) {
  functions.add(Condition{"*cur-region*",
                          [](const World& world) {
                            const auto region = region_here(world);
                            return region ? region_value(world, *region) : Value();
                          },
                          "the region of the map that the robot is in"});
  functions.add(Condition{"*cur-place*",
                          [](const World& world) {
                            const auto region = region_here(world);
                            return region ? Value(world.around.topology->text(*region)) : Value();
                          },
                          "its name"});
  functions.add(Condition{"*corridor*", corridor_here,
                          "the corridor that the robot is in, on the map or seen"});
  functions.add(Condition{"in-corridor",
                          [](const World& world) { return yes(corridor_here(world).truthy()); },
                          "whether it is in one"});
  functions.add(Condition{"map-known",
                          [](const World& world) { return yes(world.around.topology != nullptr); },
                          "whether there is a map"});
  functions.add(Condition{"lost",
                          [](const World& world) {
                            return yes(world.around.registration.state == Localization::kLost);
                          },
                          "whether it has found that it does not"});
  functions.add(Condition{"door-ahead",
                          [](const World& world) {
                            return seen_value(nearest(
                                world, PointType::door, [](const lps::Percept&, const Pose& in) {
                                  return in.x > 0.0 && std::hypot(in.x, in.y) < 2.5 &&
                                         std::abs(std::atan2(in.y, in.x)) < radians(75.0);
                                }));
                          },
                          "the nearest door that is seen within 2.5 m before the robot"});
  functions.add(Condition{"way-blocked",
                          [](const World& world) { return yes(free_ahead(world, 0.0) < 0.5); },
                          "whether something is within half a metre straight ahead"});
}

}  // namespace

void add_navigation(Functions& functions) {
  add_paths(functions);
  add_places(functions);
  add_corridors(functions);
  add_conditions(functions);
  add_seeing(functions);
  add_mapping(functions);
}

std::shared_ptr<const Functions> all_functions() {
  auto functions = std::make_shared<Functions>(core_functions());
  add_navigation(*functions);
  return functions;
}

}  // namespace saphira::intentions
