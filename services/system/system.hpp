#pragma once

#include <vector>

#include "saphira/runtime/component.hpp"
#include "saphira/runtime/wiring.hpp"

namespace saphira::system {

/// The cyclic services, each with options of its own. The one list of them: programs that run
/// several, the table of the system and its drawing come from here.
std::vector<runtime::Component> services();

/// The whole robot in the table: the bridge and the services.
std::vector<runtime::Unit> units();

}  // namespace saphira::system
