#pragma once

#include <string>

#include "saphira/idl/system.hpp"

namespace saphira::bus {

// Words in the reason of a status that readers act upon.

/// Another program of the same name and for the same robot, such as "another bridge, process 12 at
/// attic,". The reason begins with these words.
std::string another(const v1::ServiceStatus& other);
/// True where the program has found another one of its name for its robot.
bool has_namesake(const v1::ServiceStatus& status);
/// True where the program waits for a sample of its robot (robot/...), which the bridge writes.
bool waits_for_robot(const v1::ServiceStatus& status);

/// True where the program does its work, be it in part.
bool serves(const v1::ServiceStatus& status);

}  // namespace saphira::bus
