#include "saphira/logs/stamps.hpp"

#include <utility>
#include <vector>

namespace saphira::logs {

double time_of(const Stamps& stamps, Clock clock) {
  return clock == Clock::ipc ? stamps.ipc : stamps.logger;
}

std::size_t steps_back(const CarmenLog& log, Clock clock) {
  constexpr double kJitter = 2.0;  // [s]
  std::size_t count = 0;
  for (std::size_t i = 1; i < log.scans.size(); ++i)
    if (time_of(log.scans[i].time, clock) < time_of(log.scans[i - 1].time, clock) - kJitter)
      ++count;
  return count;
}

Trajectory dead_reckoning(const CarmenLog& log, Clock clock) {
  std::vector<StampedPose> poses;
  for (const LaserScan& scan : log.scans)
    poses.push_back({time_of(scan.time, clock), scan.pose});
  for (const OdomRecord& record : log.odometry)
    poses.push_back({time_of(record.time, clock), record.pose});
  return Trajectory(std::move(poses));
}

}  // namespace saphira::logs
