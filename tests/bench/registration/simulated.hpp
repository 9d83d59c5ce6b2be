#pragma once

#include <string>

#include "saphira/logs/data_set.hpp"

namespace saphira::bench {

/// A simulated robot on a round through a world of config/worlds (office-floor or loop), with a
/// laser of 180 beams. Dead reckoning errs `errors` times as much as that of the robot's
/// description.
logs::DataSet simulate_data_set(const std::string& world, double errors, std::uint64_t seed,
                                int cycles);

}  // namespace saphira::bench
