#pragma once

#include <memory>
#include <vector>

#include "saphira/intentions/functions.hpp"

namespace saphira::intentions {

/// The functions by which activities find their way: regions, doors and paths of the map, corridors
/// and doors as the LPS has them, what is in the way. The table in the README.
///
/// A path is a list of what is to be gone through: region, way out, region, ..., region, and a
/// point where the place has one. It is good for one revision of the map. Ways that proved closed
/// are in the environment variable *closed-ways*; `find-path` leaves them out for five minutes. So
/// it does with what people warn of, as long as the belief `hazards` names it.
void add_navigation(Functions& functions);

/// Where the rest of a path leads [m] [map]: through its ways out and to its end. Nothing where it
/// is of another revision of the map.
std::vector<Vec2> way_points(const Surroundings& around, const Value& path);

/// core_functions() and these: all that the shipped activities use.
std::shared_ptr<const Functions> all_functions();

}  // namespace saphira::intentions
