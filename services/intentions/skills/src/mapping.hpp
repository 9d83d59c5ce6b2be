#pragma once

#include "saphira/intentions/functions.hpp"
#include "saphira/intentions/schema.hpp"

namespace saphira::intentions {

/// explore_unknown: drives to the ends of the map built so far, until none are left.
Schema explore_unknown();

/// Actions on the map: clear it, and add seen artifacts.
void add_mapping(Functions& functions);

}  // namespace saphira::intentions
