#pragma once

#include <memory>

#include "saphira/intentions/functions.hpp"

namespace saphira::intentions {

/// What activities need to find their way: regions, doors and paths of the map, corridors and doors
/// as the LPS has them, what is in the way. The table in the README.
///
/// A path is a list of what is to be gone through: region, way out, region, ..., region, and a
/// point where the place has one. It is good for one revision of the map. Ways that proved closed
/// are in the environment variable *closed-ways*; `find-path` leaves them out for five minutes.
void add_navigation(Functions& functions);

/// What a value is called: what there is on the map by its name.
std::string name_of(const World& world, const Value& value);

/// core_functions() and these: all that the shipped activities use.
std::shared_ptr<const Functions> all_functions();

}  // namespace saphira::intentions
