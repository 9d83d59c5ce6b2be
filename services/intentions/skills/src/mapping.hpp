#pragma once

#include "saphira/intentions/functions.hpp"
#include "saphira/intentions/schema.hpp"

namespace saphira::intentions {

/// explore_unknown: drives where the map as it is built ends, until nothing is left.
Schema explore_unknown();

/// What activities ask of the map: to forget it, and to add what is seen.
void add_mapping(Functions& functions);

}  // namespace saphira::intentions
