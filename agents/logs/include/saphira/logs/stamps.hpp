#pragma once

#include <cstddef>

#include "saphira/logs/carmen.hpp"
#include "saphira/logs/metrics.hpp"

namespace saphira::logs {

/// The clock for reading the log: that of the sender, or of the logger.
enum class Clock { ipc, logger };
double time_of(const Stamps& stamps, Clock clock);

/// The number of scans stamped more than two seconds before their predecessor.
std::size_t steps_back(const CarmenLog& log, Clock clock);

/// Dead reckoning at every message of a log.
Trajectory dead_reckoning(const CarmenLog& log, Clock clock);

}  // namespace saphira::logs
