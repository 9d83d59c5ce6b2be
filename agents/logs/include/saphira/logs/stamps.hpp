#pragma once

#include <vector>

#include "saphira/logs/carmen.hpp"
#include "saphira/logs/metrics.hpp"

namespace saphira::logs {

/// A log's dead reckoning over time.
struct TimeBase {
  Trajectory odometry;
  std::size_t mended = 0;  ///< scans with replaced stamps
};

/// The clock for reading the log: that of the sender, or of the logger.
enum class Clock { ipc, logger };
double time_of(const Stamps& stamps, Clock clock);

/// The number of scans stamped more than two seconds before their predecessor.
std::size_t steps_back(const CarmenLog& log, Clock clock);

/// Dead reckoning at every message of a raw log.
TimeBase time_base(const CarmenLog& raw, Clock clock);

/// For a thinned raw log with interpolated stamps, and a corrected file of the same drive. Between
/// two scans the corrected file's ODOM lines continue from the corrected pose by raw dead
/// reckoning: with the raw pose in place of the corrected one they give dead reckoning with its
/// original stamps. Only stamps and these increments are taken from the corrected file, not its
/// poses. Scans that are missing there get the time at which dead reckoning had their pose, within
/// a second of their own stamp; the scans are put in the order of time.
TimeBase mend_stamps(CarmenLog& raw, const CarmenLog& corrected);

/// The offset of a corrected file's clock from the raw log's [s], by the scans in both. Nothing
/// without common scans.
std::optional<double> clock_offset(const CarmenLog& raw, Clock clock, const CarmenLog& corrected);

}  // namespace saphira::logs
