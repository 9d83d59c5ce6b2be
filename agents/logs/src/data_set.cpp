#include "saphira/logs/data_set.hpp"

#include <algorithm>
#include <utility>

namespace saphira::logs {

namespace {

/// The clock for reading the log.
using Clock = double Stamps::*;

/// The number of scans stamped more than two seconds before their predecessor.
std::size_t steps_back(const CarmenLog& log, Clock clock) {
  constexpr double kJitter = 2.0;  // [s]
  std::size_t count = 0;
  for (std::size_t i = 1; i < log.scans.size(); ++i)
    if (log.scans[i].time.*clock < log.scans[i - 1].time.*clock - kJitter)
      ++count;
  return count;
}

}  // namespace

double DataSet::way() const {
  double sum = 0.0;
  for (std::size_t i = 1; i < poses_in_odom.size(); ++i)
    sum += (poses_in_odom[i].position() - poses_in_odom[i - 1].position()).norm();
  return sum;
}

DataSet load_data_set(const std::string& name, const std::string& path) {
  constexpr double kLaserReach = 20.0;  // [m]
  DataSet set;
  set.name = name;
  std::string trouble;
  CarmenLog log = parse_carmen(read_log(path, &trouble), path);
  if (!trouble.empty())
    set.notes.push_back(trouble);
  set.notes.insert(set.notes.end(), log.notes.begin(), log.notes.end());
  // A clock that was set back hides earlier scans; the other clock may be sound.
  const bool other = steps_back(log, &Stamps::ipc) > 0 && steps_back(log, &Stamps::logger) == 0;
  const Clock clock = other ? &Stamps::logger : &Stamps::ipc;
  if (const std::size_t back = steps_back(log, clock); back > 0)
    set.notes.push_back(std::to_string(back) +
                        " scans are stamped seconds before the scan that stands before them");
  std::stable_sort(log.scans.begin(), log.scans.end(), [&](const LaserScan& a, const LaserScan& b) {
    return a.time.*clock < b.time.*clock;
  });
  for (const LaserScan& scan : log.scans) {
    set.times.push_back(scan.time.*clock);
    set.poses_in_odom.push_back(scan.pose);
    Beams beams;
    beams.first_angle = scan.first_angle;
    beams.step = scan.step;
    beams.sensor_in_robot = scan.laser_in_robot;
    beams.max_range = std::min(kLaserReach, scan.no_return);
    set.scans.push_back(make_scan(scan.ranges, beams));
  }
  set.damaged = std::move(log.damaged);
  return set;
}

}  // namespace saphira::logs
