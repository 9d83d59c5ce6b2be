#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "saphira/intentions/functions.hpp"
#include "saphira/lps/percept.hpp"
#include "saphira/maps/topology.hpp"

/// The place on the map that a value of the activity language means, and a place as such a value.
/// A `function` is named by the ActivityError where it does not mean what it has to.
namespace saphira::intentions {

/// [m] outside of its region the robot may believe to be.
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
/// Where the argument is: a point is itself; regions and ways out by the map; what is seen in odom.
Point point_at(const World& world, Values arguments, std::size_t index, std::string_view function);
/// The same; none where it has no place.
std::optional<Point> place_of(const World& world, const Value& value);
/// The place that a person or an activity means.
std::optional<maps::Place> place_named(const maps::Topology& map, const Value& value);

Value region_value(const World& world, std::size_t index);
Value link_value(const World& world, std::size_t index);
Value on_map(const Pose& pose);
Value on_map(const Vec2& position, double heading = 0.0);

/// A point as the robot sees it; none while the way there goes over a map on which the robot is
/// not.
std::optional<Pose> in_robot(const World& world, const Point& point);
std::optional<std::size_t> region_here(const World& world);

}  // namespace saphira::intentions
