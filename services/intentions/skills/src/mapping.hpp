#pragma once

#include "saphira/intentions/functions.hpp"
#include "saphira/intentions/schema.hpp"

namespace saphira::intentions {

/// explore_unknown: drives where the map as it is built ends, until nothing is left.
Schema explore_unknown();

/// Actions on the map: to forget it, and to add the artifacts that are seen.
void add_mapping(Functions& functions);

}  // namespace saphira::intentions
