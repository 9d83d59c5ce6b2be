#pragma once

#include <string>
#include <vector>

#include "saphira/runtime/component.hpp"
#include "saphira/runtime/wiring.hpp"

namespace saphira::system {

/// The cyclic services, each with its own options. Programs that run several services, the table of
/// the system and its drawing use this one list.
std::vector<runtime::Component> services();

/// The units of the whole robot: the bridge and the services.
std::vector<runtime::Unit> units();

/// The one unit that writes this topic, once a cycle, such as bridge; empty: there is none.
std::string only_writer(const std::string& topic);

}  // namespace saphira::system
