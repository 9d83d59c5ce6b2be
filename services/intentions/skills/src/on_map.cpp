#include "on_map.hpp"

#include <charconv>
#include <string>

#include "saphira/lps/seen_thing.hpp"

namespace saphira::intentions {
namespace {

using Kind = Reference::Kind;

[[noreturn]] void stale(std::string_view function) {
  throw ActivityError(std::string(function) + ": the map has changed since");
}

}  // namespace

const maps::Topology& map_of(const World& world, std::string_view function) {
  if (world.around.topology == nullptr)
    throw ActivityError(std::string(function) + ": there is no map", v1::CODE_NO_ROUTE);
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
  return Value(Point{pose, Frame::map});
}

Value on_map(const Vec2& position, double heading) {
  return on_map(Pose{position.x(), position.y(), heading});
}

std::optional<Pose> in_robot(const World& world, const Point& point) {
  return in_frame(point.pose, point.frame, Frame::robot, world.robot);
}

const lps::Percept* percept(const World& world, std::uint64_t id) {
  if (world.around.percepts != nullptr)
    for (const lps::Percept& each : *world.around.percepts)
      if (each.id == id)
        return &each;
  return nullptr;
}

std::optional<Point> place_of(const World& world, const Value& value) {
  if (const Point* const point = value.point())
    return *point;
  const Reference* const reference = value.reference();
  if (reference == nullptr)
    return std::nullopt;
  if (reference->kind == Kind::kPercept) {
    const lps::Percept* const seen = percept(world, reference->id);
    return seen == nullptr ? std::nullopt : std::optional(Point{seen->pose_in_odom, Frame::odom});
  }
  if (reference->kind == Kind::kThing) {
    const lps::SeenThing* const seen = seen_thing(world, reference->id);
    return seen == nullptr ? std::nullopt : std::optional(Point{seen->pose_in_odom, Frame::odom});
  }
  if (!current(world, *reference))
    return std::nullopt;
  const maps::Topology& map = *world.around.topology;
  if (reference->kind == Kind::kRegion && reference->id < map.regions().size())
    return Point{map.regions()[reference->id].area.pose_in_map, Frame::map};
  if (reference->kind == Kind::kLink && reference->id < map.links().size())
    return Point{map.links()[reference->id].pose_in_map, Frame::map};
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

}  // namespace saphira::intentions
