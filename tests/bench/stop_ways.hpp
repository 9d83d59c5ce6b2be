#pragma once

#include <nlohmann/json.hpp>

namespace saphira::bench {

/// All ways to stop the robot times all ways to move it, with the programs of a deployment and the
/// simulator's trace as the truth. Prints a line for each; the result has:
///   still_s_max    [s] from the bridge's first grant with the stop to the robot at rest
///   moved_after    ways after which the robot moved although its driver had not begun anew
///   false_success  ways that reported success before the robot was at rest
///   failed         ways that did not stop it, or that could not be tried
nlohmann::json stop_ways();

}  // namespace saphira::bench
