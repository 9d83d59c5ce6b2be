#include "corridors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "on_map.hpp"
#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/lps/seen_thing.hpp"
#include "seeing.hpp"

namespace saphira::intentions {
namespace {

using lps::PointType;
using maps::LinkKind;
using maps::RegionKind;
using Kind = Reference::Kind;

constexpr double kSameDoor = 0.5;   ///< [m] tolerance between a seen door and the map's
constexpr double kBody = 0.30;      ///< [m] half of the width that has to be free ahead
constexpr double kNear = 1.6;       ///< [m] from which on the sonars detect a closed door
constexpr double kSeenAgain = 3.0;  ///< [s] older percepts do not count
constexpr double kDeep = 0.2;       ///< [m] before and behind a doorway, for obstacles in it
constexpr double kAtDoor = 1.0;     ///< [m] nearer, a person does not look like a door's leaf...
constexpr double kLeafGap = 0.25;   ///< [m] ...which leaves no wider gap
constexpr double kInDoor = 0.5;     ///< [m] before and behind a doorway, for a person in it

/// The middle line of a corridor as a directed point, towards a way out of it or a point.
Pose lane(const maps::Feature& area, const Vec2& towards) {
  Pose pose = area.pose_in_map;
  const Vec2 to = maps::on_axis(area, towards);
  pose.th = to_frame(pose, to).x() >= 0.0 ? pose.th : norm2_angle(pose.th + kPi);
  return pose;
}

/// The percept of the map's door; its place relative to the robot is the accurate one.
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
  // The normal of the map's door: the percept's is towards the robot's side.
  const Pose by_map = relative(*world.robot.odom_in_map, link.pose_in_map);
  Pose pose = seen->pose_in_odom;
  if (std::abs(norm2_angle(pose.th - by_map.th)) > kPi / 2)
    pose.th = norm2_angle(pose.th + kPi);
  return Value(Point{pose, Frame::odom});
}

/// The widest gap between obstacles in the doorway [m], from the obstacle memory.
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

/// True where the cameras see a person in a doorway.
bool seen_in(const World& world, const Pose& door_in_robot, double width) {
  if (world.around.things == nullptr)
    return false;
  return std::any_of(
      world.around.things->begin(), world.around.things->end(), [&](const lps::SeenThing& thing) {
        const Vec2 inside = to_frame(
            door_in_robot, to_frame(world.robot.pose_in_odom, thing.pose_in_odom.position()));
        return thing.kind == lps::SeenThing::Kind::person && thing.range_known &&
               seconds_unseen(world, thing) < kSeenAgain && std::abs(inside.x()) < kInDoor &&
               std::abs(inside.y()) < width / 2;
      });
}

Value door_state(const World& world, Values arguments) {
  const maps::Link& link = link_of(world, arguments, 0, "door-state");
  const std::optional<Pose> door = in_robot(world, {link.pose_in_map, Frame::map});
  if (!door || world.around.lps == nullptr || link.kind == LinkKind::meeting)
    return "unknown";
  if (seen_in(world, *door, link.width))
    return "person";
  const double bearing = std::abs(std::atan2(door->y, door->x));
  const double far = std::hypot(door->x, door->y);
  const double gap = widest_gap(*world.around.lps, *door, link.width);
  if (far > kBody && far <= kAtDoor && gap < kLeafGap)
    return "closed";
  if (far <= kNear && gap < 2.0 * kBody - 0.1)
    return "barred";
  if (far <= kNear && bearing <= radians(35.0))
    return "open";
  const lps::Percept* const seen = seen_door(world, link);
  const bool fresh = seen != nullptr && static_cast<double>(world.around.lps->cycle()) * kTick -
                                                static_cast<double>(seen->seen) * kTick <
                                            kSeenAgain;
  return fresh ? "open" : "unknown";
}

/// The direction through a door into a region, for FollowDoor. A door's normal is out into its
/// region a.
Value door_direction(const World& world, Values arguments) {
  const maps::Link& link = link_of(world, arguments, 0, "door-direction");
  const std::size_t into =
      region_index(world, reference_of(arguments, 1, "door-direction"), "door-direction");
  return link.a == into ? "out" : "in";
}

/// A point on the line through a door, at a distance on the side of a region.
Value before_door(const World& world, Values arguments) {
  const maps::Link& link = link_of(world, arguments, 0, "before-door");
  const std::size_t side =
      region_index(world, reference_of(arguments, 1, "before-door"), "before-door");
  const double far = arguments.size() > 2 ? number_of(arguments, 2, "before-door") : 0.7;
  const double sign = link.a == side ? 1.0 : -1.0;
  return on_map(transform(link.pose_in_map, {sign * far, 0.0}),
                norm2_angle(link.pose_in_map.th + (sign > 0.0 ? 0.0 : kPi)));
}

// ---- Obstacles

/// The robot's free way straight on [m], at most the range of the LPS.
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

/// The corridor around the robot: from registration, as current_environment of manual 8.1.2, or
/// else from perception.
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
      return {{seen->pose_in_odom, Frame::odom}, seen->width, seen->length};
    throw ActivityError(std::string(function) + ": it is no longer seen");
  }
  const maps::Feature& area =
      world.around.topology == nullptr
          ? throw ActivityError(std::string(function) + ": there is no map")
          : world.around.topology->regions()[region_index(world, reference, function)].area;
  return {{area.pose_in_map, Frame::map}, area.width, area.length};
}

}  // namespace

void add_corridors(Functions& functions) {
  functions.add("lane-of", 1, 2,
                "(lane-of CORRIDOR [THING]): its middle, directed as the robot is, or from "
                "the robot towards the thing",
                [](const World& world, Values arguments) {
                  const Corridor corridor = corridor_of(world, arguments, 0, "lane-of");
                  Point middle = corridor.middle;
                  const auto seen = in_robot(world, middle);
                  const auto to = arguments.size() > 1
                                      ? in_robot(world, point_at(world, arguments, 1, "lane-of"))
                                      : std::nullopt;
                  if (!seen)
                    return Value(middle);
                  // In the robot's direction, or towards the target.
                  const bool back = to ? relative(*seen, *to).x < relative(*seen, Pose{}).x
                                       : std::abs(seen->th) > kPi / 2;
                  if (back)
                    middle.pose.th = norm2_angle(middle.pose.th + kPi);
                  return Value(middle);
                });
  functions.add("on-lane", 2, 2, "(on-lane REGION THING): the nearest point on the middle line",
                [](const World& world, Values arguments) {
                  const maps::Region& region = region_of(world, arguments, 0, "on-lane");
                  const Point point = point_at(world, arguments, 1, "on-lane");
                  const auto at = in_frame(point.pose, point.frame, Frame::map, world.robot);
                  if (!at)
                    return Value();
                  const Vec2 on = maps::on_axis(region.area, at->position());
                  return on_map(on, lane(region.area, at->position()).th);
                });
  functions.add("aligned-in-lane", 4, 4,
                "(aligned-in-lane LANE TARGET LOW HIGH): 1 while the robot is turned off "
                "the way to the target by less than LOW [rad], 0 from HIGH on (manual 8.1.3)",
                [](const World& world, Values arguments) {
                  const auto lane_at =
                      in_robot(world, point_at(world, arguments, 0, "aligned-in-lane"));
                  const auto to = in_robot(world, point_at(world, arguments, 1, "aligned-in-lane"));
                  if (!lane_at || !to)
                    return Value();
                  const double low = number_of(arguments, 2, "aligned-in-lane");
                  const double high = number_of(arguments, 3, "aligned-in-lane");
                  const bool on = relative(*lane_at, *to).x >= relative(*lane_at, Pose{}).x;
                  const double off = std::abs(norm2_angle(lane_at->th + (on ? 0.0 : kPi)));
                  return Value(std::clamp((high - off) / std::max(1e-9, high - low), 0.0, 1.0));
                });
  functions.add(
      "lane-end", 1, 2, "(lane-end CORRIDOR [MARGIN]): where it ends, as the robot is turned",
      [](const World& world, Values arguments) {
        const Corridor corridor = corridor_of(world, arguments, 0, "lane-end");
        const double margin = arguments.size() > 1 ? number_of(arguments, 1, "lane-end") : 1.0;
        Point middle = corridor.middle;
        const auto seen = in_robot(world, middle);
        if (!seen)
          return Value();
        if (std::abs(seen->th) > kPi / 2)
          middle.pose.th = norm2_angle(middle.pose.th + kPi);
        const double half = std::max(0.0, corridor.length / 2 - margin);
        middle.pose = compose(middle.pose, {half, 0.0, 0.0});
        return Value(middle);
      });
  functions.add("door-pose", 1, 1,
                "(door-pose DOOR): as it is seen, or else by the map; directed out", door_pose);
  functions.add(
      "door-state", 1, 1,
      "(door-state DOOR): open, closed, barred (closed, or somebody stands in it), person (one "
      "is seen in it) or unknown",
      door_state);
  functions.add("door-direction", 2, 2,
                "(door-direction DOOR REGION): in or out, to get into the region", door_direction);
  functions.add("before-door", 2, 3,
                "(before-door DOOR REGION [M]): the point on its line on that side (0.7 m)",
                before_door);
  functions.add("free-ahead", 0, 1,
                "(free-ahead [RAD]): how far the robot could go in that direction [m]",
                [](const World& world, Values arguments) {
                  return Value(free_ahead(
                      world, arguments.empty() ? 0.0 : number_of(arguments, 0, "free-ahead")));
                });
  functions.add(
      "seen", 1, 2,
      "(seen KIND [POINT]): the nearest door, corridor, junction, wall, person, blob or blob-a to "
      "-c, or nil; of people and colours the one nearest to the point",
      [](const World& world, Values arguments) {
        const std::string& what = text_of(arguments, 0, "seen");
        std::optional<Pose> place;
        if (arguments.size() > 1 && !arguments[1].nil()) {
          const Point point = point_at(world, arguments, 1, "seen");
          place = in_frame(point.pose, point.frame, Frame::odom, world.robot);
        }
        if (const std::optional<Value> thing = nearest_seen(world, what, place))
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
      });
  functions.add("width-of", 1, 1, "(width-of THING): of a region, corridor or door [m]",
                [](const World& world, Values arguments) {
                  const Reference& reference = reference_of(arguments, 0, "width-of");
                  return Value(reference.kind == Kind::kLink
                                   ? link_of(world, arguments, 0, "width-of").width
                                   : corridor_of(world, arguments, 0, "width-of").width);
                });
  functions.add("length-of", 1, 1, "(length-of THING): of a region or corridor [m]",
                [](const World& world, Values arguments) {
                  return Value(corridor_of(world, arguments, 0, "length-of").length);
                });
  functions.add("*corridor*", "the corridor that the robot is in, on the map or seen",
                corridor_here);
  functions.add("in-corridor", "whether it is in a corridor",
                [](const World& world) { return Value::truth(corridor_here(world).truthy()); });
  functions.add("door-ahead", "the nearest door that is seen within 2.5 m before the robot",
                [](const World& world) {
                  return seen_value(
                      nearest(world, PointType::door, [](const lps::Percept& door, const Pose& in) {
                        return !door.is_closed() && in.x > 0.0 && std::hypot(in.x, in.y) < 2.5 &&
                               std::abs(std::atan2(in.y, in.x)) < radians(75.0);
                      }));
                });
  functions.add("way-blocked", "whether something is within half a metre straight ahead",
                [](const World& world) { return Value::truth(free_ahead(world, 0.0) < 0.5); });
}

}  // namespace saphira::intentions
