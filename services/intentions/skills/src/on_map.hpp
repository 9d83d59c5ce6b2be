#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "saphira/intentions/functions.hpp"
#include "saphira/lps/percept.hpp"
#include "saphira/maps/topology.hpp"

/// Conversions between values of the activity language and places on the map. The ActivityError for
/// a wrong value names the `function`.
namespace saphira::intentions {

/// [m] tolerated distance of the robot from its region.
inline constexpr double kAstray = 0.5;

const maps::Topology& map_of(const World& world, std::string_view function);

const Reference& reference_of(Values arguments, std::size_t index, std::string_view function);
/// The index of a region or link of the map's.
std::size_t region_index(const World& world, const Reference& reference, std::string_view function);
std::size_t link_index(const World& world, const Reference& reference, std::string_view function);
const maps::Region& region_of(const World& world, Values arguments, std::size_t index,
                              std::string_view function);
const maps::Link& link_of(const World& world, Values arguments, std::size_t index,
                          std::string_view function);
/// The percept of that number; nullptr where it is gone.
const lps::Percept* percept(const World& world, std::uint64_t id);
/// The place of an argument: a point is its own; regions and ways out by the map; percepts in odom.
Point point_at(const World& world, Values arguments, std::size_t index, std::string_view function);
/// The same; none for a value without a place.
std::optional<Point> place_of(const World& world, const Value& value);
/// The place with that name, from a person or an activity.
std::optional<maps::Place> place_named(const maps::Topology& map, const Value& value);

Value region_value(const World& world, std::size_t index);
Value link_value(const World& world, std::size_t index);
Value on_map(const Pose& pose);
Value on_map(const Vec2& position, double heading = 0.0);

/// A point in the robot's frame; none where the conversion goes over a map on which the robot has
/// no pose.
std::optional<Pose> in_robot(const World& world, const Point& point);
std::optional<std::size_t> region_here(const World& world);

}  // namespace saphira::intentions
