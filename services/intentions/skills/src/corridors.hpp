#pragma once

#include "saphira/intentions/functions.hpp"

namespace saphira::intentions {

/// Corridors and doors, by the map and as they are seen, and what stands in the way.
void add_corridors(Functions& functions);

}  // namespace saphira::intentions
