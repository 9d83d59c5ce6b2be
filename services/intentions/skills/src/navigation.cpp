#include "saphira/intentions/navigation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "corridors.hpp"
#include "mapping.hpp"
#include "on_map.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/maps/route.hpp"
#include "saphira/maps/topology.hpp"
#include "seeing.hpp"
#include "zones.hpp"

namespace saphira::intentions {
namespace {

using maps::LinkKind;
using maps::RegionKind;
using Kind = Reference::Kind;

constexpr double kForget = 300.0;  ///< [s] after which a closed way may be open again
constexpr double kThere = 0.4;     ///< [m] distance to its point at which a place is reached
constexpr double kBeside = 3.0;    ///< [m] a nearer point in the robot's region needs no path
constexpr double kVisited = 1.5;   ///< [m] around the robot's earlier places
constexpr double kStep = 0.7;      ///< [m] nearer points are not worth a drive
constexpr double kWayIn = 1.0;     ///< [m] behind a door, where a room counts as visited

const char* const kClosedWays = "*closed-ways*";

double seconds(const World& world) {
  return static_cast<double>(world.now) * kTick;
}

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
  if (world.around.robot_radius > 0.0)
    settings.needs_width = maps::needed_width(world.around.robot_radius);
  settings.zones = zones_of(world);
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

maps::RouteResult route(const World& world, const Value& from, const Value& to,
                        bool all_open = false) {
  const maps::Topology& map = map_of(world, "find-path");
  std::optional<Vec2> start;
  if (const std::optional<Pose> robot = world.robot_in_map())
    start = robot->position();
  // From another place than the robot's.
  if (const Reference* const region = from.reference()) {
    const bool here = start && region->kind == Kind::kRegion && current(world, *region) &&
                      region->id < map.regions().size() &&
                      maps::distance_to(map.regions()[region->id].area, *start) <= kAstray;
    const std::optional<Point> point = here ? std::nullopt : place_of(world, from);
    if (point && point->frame == Frame::map)
      start = point->pose.position();
  } else if (from.point() != nullptr) {
    const auto point = in_frame(from.point()->pose, from.point()->frame, Frame::map, world.robot);
    start = point ? std::optional(point->position()) : std::nullopt;
  }
  if (!start)
    return {std::nullopt, "the robot does not know where it is on the map"};
  maps::RouteSettings settings = route_settings(world);
  if (all_open) {
    settings.blocked.clear();
    settings.blocked_links.clear();
  }
  if (const Reference* const region = to.reference()) {
    maps::Place place;
    place.name = name_of(world, to);
    if (region->kind == Kind::kRegion && current(world, *region))
      place.regions = {region->id};
    return maps::find_route(map, *start, place, settings);
  }
  if (to.point() != nullptr) {
    const auto goal = in_frame(to.point()->pose, to.point()->frame, Frame::map, world.robot);
    if (!goal)
      return {std::nullopt, "the robot does not know where it is on the map"};
    return maps::find_route(map, *start, goal->position(), settings);
  }
  const std::optional<maps::Place> place = place_named(map, to);
  if (!place)
    return {std::nullopt, map.no_place(spoken(to))};
  return maps::find_route(map, *start, *place, settings);
}

/// The zone that forbids the rest of a path, from the robot's place; empty: none.
std::string hazard_on(const World& world, const Value& path) {
  const std::optional<Pose> robot = world.robot_in_map();
  const maps::RouteSettings settings = route_settings(world);
  if (settings.zones.empty() || !robot)
    return {};
  std::vector<maps::Leg> legs;
  std::optional<Vec2> end;
  for (const Value& each : path.list()) {
    const Reference* const reference = each.reference();
    if (each.point() != nullptr && each.point()->frame == Frame::map) {
      end = each.point()->pose.position();
    } else if (reference != nullptr && current(world, *reference)) {
      if (reference->kind == Kind::kRegion)
        legs.push_back({reference->id, std::nullopt, {}});
      else if (!legs.empty())
        legs.back().link = reference->id;
    }
  }
  return maps::forbidden(*world.around.topology, robot->position(), legs, end, settings);
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
    if (const auto goal = in_frame(to.point()->pose, to.point()->frame, Frame::map, world.robot))
      end = goal->position();
  } else if (to.reference() == nullptr) {
    if (const auto place = place_named(*world.around.topology, to))
      end = place->point;
  }
  if (end)
    path.push_back(on_map(*end));
  return Value(std::move(path));
}

/// The kind of the first step of a path, by which follow-path chooses: the name of a schema, or
/// done.
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

// ---- Exploring

/// The targets of exploring: the ends of corridors, and rooms behind their doors.
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
                in_frame(each.point()->pose, each.point()->frame, Frame::map, world.robot))
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

/// A place where registration may find known artifacts: on the way to the nearest corridor, from
/// its best guess of the pose. In odom; nil without a guess.
Value way_to_corridor(const World& world, Values) {
  const Registered& guess = world.around.registration;
  if (world.around.topology == nullptr || !guess.state || guess.state == v1::REGISTRATION_UNPLACED)
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
          Point{compose(world.robot.pose_in_odom, {seen.x(), seen.y(), 0.0}), Frame::odom});
    }
  return {};
}

void add_paths(Functions& functions) {
  functions.add("find-path", 2, 2,
                "(find-path FROM TO): the regions and ways out to go through, or nil",
                [](const World& world, Values arguments) {
                  const maps::RouteResult found = route(world, arguments[0], arguments[1]);
                  return found.route ? path_of(world, *found.route, arguments[1]) : Value();
                });
  functions.add("why-no-path", 2, 2,
                "(why-no-path FROM TO): the reason why find-path gives nil, or nil",
                [](const World& world, Values arguments) {
                  const maps::RouteResult found = route(world, arguments[0], arguments[1]);
                  return found.route ? Value() : Value(found.reason);
                });
  functions.add(
      "could-be-opened", 2, 2,
      "(could-be-opened FROM TO): whether there would be a way if nothing were closed or blocked",
      [](const World& world, Values arguments) {
        return Value::truth(route(world, arguments[0], arguments[1], true).route.has_value());
      });
  functions.add("way-length", 2, 2,
                "(way-length FROM TO): of the way that find-path finds [m], or nil",
                [](const World& world, Values arguments) {
                  const maps::RouteResult found = route(world, arguments[0], arguments[1]);
                  return found.route ? Value(found.route->length) : Value();
                });
  functions.add("path-current", 1, 1,
                "(path-current PATH): whether the map is still the one that it is of",
                [](const World& world, Values arguments) {
                  for (const Value& each : arguments[0].list())
                    if (each.reference() != nullptr && !current(world, *each.reference()))
                      return Value();
                  return Value::truth(true);
                });
  functions.add("hazard-on", 1, 1,
                "(hazard-on PATH): the zone, of the map or by advice, that forbids the "
                "rest of it, or nil",
                [](const World& world, Values arguments) {
                  const std::string hazard = hazard_on(world, arguments[0]);
                  return hazard.empty() ? Value() : Value(hazard);
                });
  functions.add("keep-out-ahead", 0, 0,
                "(keep-out-ahead): the zone before the robot that it may not enter, or nil",
                [](const World& world, Values) {
                  const std::string zone = keep_out_ahead(world);
                  return zone.empty() ? Value() : Value(zone);
                });
  functions.add(
      "zones-on", 1, 1, "(zones-on PATH): the zones that it goes out of, around or through, or nil",
      [](const World& world, Values arguments) {
        const Value::List& path = arguments[0].list();
        const std::string remark = path.empty() ? "" : route(world, Value(), path.back()).remark();
        return remark.empty() ? Value() : Value(remark);
      });
  functions.add("path-text", 1, 1, "(path-text PATH): in words",
                [](const World& world, Values arguments) {
                  std::string text;
                  for (const Value& each : arguments[0].list()) {
                    const Reference* const way = each.reference();
                    if (way != nullptr && way->kind == Kind::kLink && current(world, *way) &&
                        world.around.topology->links()[way->id].kind == LinkKind::meeting)
                      continue;
                    text += (text.empty() ? "" : ", ") + name_of(world, each);
                  }
                  return Value(text);
                });
  functions.add("leg", 1, 1, "(leg PATH): the name of the schema for its beginning, on, or done",
                leg_of);
  functions.add(
      "closed-ways-with", 1, 1, "(closed-ways-with WAY): *closed-ways* and that one, as of now",
      [](const World& world, Values arguments) {
        const Reference& way = reference_of(arguments, 0, "closed-ways-with");
        Value::List ways;
        for (const auto& [each, since] : closed_ways(world.beliefs.get(kClosedWays, world)))
          if (!(each == way) && seconds(world) - since < kForget)
            ways.push_back(Value(Value::List{Value(each), Value(since)}));
        ways.push_back(Value(Value::List{Value(way), Value(seconds(world))}));
        return Value(std::move(ways));
      });
  functions.add("way-to-corridor", 0, 0,
                "(way-to-corridor): where to go to find out where it is, by the best guess",
                way_to_corridor);
  functions.add("next-to-explore", 1, 2,
                "(next-to-explore VISITED [ROOMS]): the nearest end of a corridor (and room) "
                "that is none of the points, or nil",
                next_to_explore);
}

/// True where the robot is at a place: in its region, as find-path sees it, and near its point
/// where it has one.
bool at_place(const World& world, const Value& place) {
  const std::optional<Pose> robot = world.robot_in_map();
  if (!robot || world.around.topology == nullptr)
    return false;
  if (place.point() != nullptr) {
    const auto at = in_frame(place.point()->pose, place.point()->frame, Frame::map, world.robot);
    return at && (at->position() - robot->position()).norm() < kThere;
  }
  const auto meant = place_named(*world.around.topology, place);
  if (!meant)
    return false;
  if (meant->point)
    return (*meant->point - robot->position()).norm() < kThere;
  const std::optional<std::size_t> here = region_here(world);
  return std::any_of(meant->regions.begin(), meant->regions.end(), [&](std::size_t region) {
    return here == region ||
           maps::contains(world.around.topology->regions()[region].area, robot->position());
  });
}

bool beside(const World& world, const Value& place) {
  const Point* const point = place.point();
  const auto region = region_here(world);
  if (point == nullptr || !region)
    return false;
  const auto ahead = in_robot(world, *point);
  const auto at = in_frame(point->pose, point->frame, Frame::map, world.robot);
  return ahead && at && std::hypot(ahead->x, ahead->y) < kBeside &&
         world.around.topology->region_at(at->position(), kAstray) == region;
}

Value arrival(const World& world, Values arguments) {
  if (arguments[0].point() != nullptr)
    if (const auto at = in_robot(world, *arguments[0].point())) {
      char text[64];
      std::snprintf(text, sizeof text, "arrived, %.2f m from the point", std::hypot(at->x, at->y));
      return Value(text);
    }
  const auto region = region_here(world);
  return Value("the robot is at " + (region ? world.around.topology->text(*region) : "its place"));
}

/// The parts of a text between its commas; without a comma, its words.
Value split(const std::string& text) {
  const char between = text.find(',') != std::string::npos ? ',' : ' ';
  Value::List parts;
  std::string part;
  for (const char c : text + between) {
    if (c != between) {
      if (c != ' ' || !part.empty())
        part += c;
      continue;
    }
    part.erase(part.find_last_not_of(' ') + 1);
    if (!part.empty())
      parts.emplace_back(part);
    part.clear();
  }
  return Value(std::move(parts));
}

void add_places(Functions& functions) {
  functions.add("at-place", 1, 1, "(at-place PLACE): whether the robot is there",
                [](const World& world, Values arguments) {
                  return Value::truth(at_place(world, arguments[0]));
                });
  functions.add("beside", 1, 1, "(beside PLACE): whether it is a near point in the robot's region",
                [](const World& world, Values arguments) {
                  return Value::truth(beside(world, arguments[0]));
                });
  functions.add("arrival", 1, 1, "(arrival PLACE): in words: how near its point, or in what region",
                arrival);
  functions.add(
      "split", 1, 1, "(split TEXT): its parts between commas; without a comma, its words",
      [](const World&, Values arguments) { return split(text_of(arguments, 0, "split")); });
  functions.add(
      "room-p", 1, 1, "(room-p THING): whether it is a room of the map",
      [](const World& world, Values arguments) {
        const Reference* const reference = arguments[0].reference();
        return Value::truth(reference != nullptr && reference->kind == Kind::kRegion &&
                            current(world, *reference) &&
                            region_of(world, arguments, 0, "room-p").kind == RegionKind::room);
      });
  functions.add("link-p", 1, 1, "(link-p THING): whether it is a door or another way out",
                [](const World&, Values arguments) {
                  const Reference* const reference = arguments[0].reference();
                  return Value::truth(reference != nullptr && reference->kind == Kind::kLink);
                });
  functions.add("place-known", 1, 1, "(place-known NAME): whether the map has it",
                [](const World& world, Values arguments) {
                  return Value::truth(world.around.topology != nullptr &&
                                      (arguments[0].point() != nullptr ||
                                       place_named(*world.around.topology, arguments[0])));
                });
  functions.add("why-no-place", 1, 1,
                "(why-no-place NAME): that the map does not have it, and the names that it has",
                [](const World& world, Values arguments) {
                  return Value(world.around.topology == nullptr
                                   ? "there is no map"
                                   : world.around.topology->no_place(spoken(arguments[0])));
                });
  functions.add(
      "name-of", 1, 1, "(name-of THING): what it is called",
      [](const World& world, Values arguments) { return Value(name_of(world, arguments[0])); });
  functions.add("region-at", 1, 1, "(region-at POINT): of the map, or nil",
                [](const World& world, Values arguments) {
                  const Point point = point_at(world, arguments, 0, "region-at");
                  const auto at = in_frame(point.pose, point.frame, Frame::map, world.robot);
                  if (!at || world.around.topology == nullptr)
                    return Value();
                  const auto region = world.around.topology->region_at(at->position(), kAstray);
                  return region ? region_value(world, *region) : Value();
                });
  functions.add("in-region", 1, 1, "(in-region REGION): whether the robot is",
                [](const World& world, Values arguments) {
                  const maps::Region& region = region_of(world, arguments, 0, "in-region");
                  const std::optional<Pose> robot = world.robot_in_map();
                  return Value::truth(robot && maps::contains(region.area, robot->position()));
                });
  functions.add("place-of", 1, 1, "(place-of THING): its middle, directed, as a point",
                [](const World& world, Values arguments) {
                  return Value(point_at(world, arguments, 0, "place-of"));
                });
  functions.add("here", 0, 0, "(here): where the robot is: on the map, or else in odom",
                [](const World& world, Values) {
                  if (const auto robot = world.robot_in_map())
                    return on_map(*robot);
                  return Value(Point{world.robot.pose_in_odom, Frame::odom});
                });
  functions.add("distance-to", 1, 1,
                "(distance-to THING): from the robot to its middle [m]; nil if unknown",
                [](const World& world, Values arguments) {
                  const auto at = in_robot(world, point_at(world, arguments, 0, "distance-to"));
                  return at ? Value(std::hypot(at->x, at->y)) : Value();
                });
  functions.add("bearing-of", 1, 1,
                "(bearing-of THING): from the robot's heading [rad], left positive",
                [](const World& world, Values arguments) {
                  const auto at = in_robot(world, point_at(world, arguments, 0, "bearing-of"));
                  return at ? Value(std::atan2(at->y, at->x)) : Value();
                });
  functions.add(
      "distance-along", 2, 2, "(distance-along LANE THING): how far it is along the lane [m]",
      [](const World& world, Values arguments) {
        const auto lane_at = in_robot(world, point_at(world, arguments, 0, "distance-along"));
        const auto to = in_robot(world, point_at(world, arguments, 1, "distance-along"));
        if (!lane_at || !to)
          return Value();
        return Value(relative(*lane_at, *to).x - relative(*lane_at, Pose{}).x);
      });
}

void add_conditions(Functions& functions) {
  functions.add("*cur-region*", "the region of the map that the robot is in",
                [](const World& world) {
                  const auto region = region_here(world);
                  return region ? region_value(world, *region) : Value();
                });
  functions.add("*cur-place*", "its name", [](const World& world) {
    const auto region = region_here(world);
    return region ? Value(world.around.topology->text(*region)) : Value();
  });
  functions.add("map-known", "whether there is a map",
                [](const World& world) { return Value::truth(world.around.topology != nullptr); });
  functions.add("lost", "whether it has lost its place on the map", [](const World& world) {
    return Value::truth(world.around.registration.state == v1::REGISTRATION_LOST);
  });
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

std::vector<Vec2> way_points(const Surroundings& around, const Value& path) {
  std::vector<Vec2> points;
  for (const Value& each : path.list()) {
    const Reference* const reference = each.reference();
    if (each.point() != nullptr && each.point()->frame == Frame::map) {
      points.push_back(each.point()->pose.position());
    } else if (reference != nullptr && reference->kind == Kind::kLink) {
      if (around.topology == nullptr || reference->revision != around.map_revision ||
          reference->id >= around.topology->links().size())
        return {};
      points.push_back(around.topology->links()[reference->id].pose_in_map.position());
    }
  }
  return points;
}

std::shared_ptr<const Functions> all_functions() {
  auto functions = std::make_shared<Functions>(core_functions());
  add_navigation(*functions);
  return functions;
}

}  // namespace saphira::intentions
