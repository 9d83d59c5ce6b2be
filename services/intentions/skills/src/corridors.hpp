#pragma once

#include "saphira/intentions/functions.hpp"

namespace saphira::intentions {

/// Corridors and doors, of the map and of perception, and obstacles.
void add_corridors(Functions& functions);

}  // namespace saphira::intentions
