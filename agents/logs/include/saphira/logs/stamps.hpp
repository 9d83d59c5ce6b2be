#pragma once

#include <vector>

#include "saphira/logs/carmen.hpp"
#include "saphira/logs/metrics.hpp"

namespace saphira::logs {

/// A log's dead reckoning over time.
struct TimeBase {
  Trajectory odometry;
  std::size_t mended = 0;  ///< scans whose stamps were not the original ones
};

/// Which of the two stamps the log is read by: that of the sender, or of the logger.
enum class Clock { ipc, logger };
double time_of(const Stamps& stamps, Clock clock);

/// How many scans are stamped more than two seconds before the one that stands before them.
std::size_t steps_back(const CarmenLog& log, Clock clock);

/// Dead reckoning at every message of a raw log.
TimeBase time_base(const CarmenLog& raw, Clock clock);

/// For a raw log that was thinned, with stamps interpolated, beside a corrected file of the same
/// drive. Between two scans the corrected file's ODOM lines go on from the corrected pose as raw
/// dead reckoning went: with the raw pose put in the place of the corrected one they give dead
/// reckoning with its original stamps. Only stamps and these increments are taken from the
/// corrected file; its poses are not. Scans that it does not hold get the time at which dead
/// reckoning was where they say, within a second of their own stamp; the scans are put in the order
/// of time.
TimeBase mend_stamps(CarmenLog& raw, const CarmenLog& corrected);

/// The clock of a corrected file against that of the raw log [s], by the scans that both hold.
/// Nothing where they have none in common.
std::optional<double> clock_offset(const CarmenLog& raw, Clock clock, const CarmenLog& corrected);

}  // namespace saphira::logs
