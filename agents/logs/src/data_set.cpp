#include "saphira/logs/data_set.hpp"

#include <algorithm>
#include <utility>

#include "saphira/logs/stamps.hpp"

namespace saphira::logs {

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
  const bool other = steps_back(log, Clock::ipc) > 0 && steps_back(log, Clock::logger) == 0;
  const Clock clock = other ? Clock::logger : Clock::ipc;
  if (const std::size_t back = steps_back(log, clock); back > 0)
    set.notes.push_back(std::to_string(back) +
                        " scans are stamped seconds before the scan that stands before them");
  std::stable_sort(log.scans.begin(), log.scans.end(), [&](const LaserScan& a, const LaserScan& b) {
    return time_of(a.time, clock) < time_of(b.time, clock);
  });
  for (const LaserScan& scan : log.scans) {
    set.times.push_back(time_of(scan.time, clock));
    set.poses_in_odom.push_back(scan.pose);
    Beams beams;
    beams.first_angle = scan.first_angle;
    beams.step = scan.step;
    beams.sensor_in_robot = scan.laser_in_robot;
    beams.max_range = std::min(kLaserReach, scan.no_return);
    set.scans.push_back(make_scan(scan.ranges, beams));
  }
  set.odometry = dead_reckoning(log, clock);
  set.damaged = std::move(log.damaged);
  return set;
}

SonarDrive virtual_drive(const DataSet& set, std::vector<lps::SonarMount> mounts) {
  SonarDrive drive;
  drive.ring.mounts = std::move(mounts);
  drive.times = set.times;
  drive.poses_in_odom = set.poses_in_odom;
  for (const Scan& scan : set.scans)
    drive.readings.push_back(hear(scan, drive.ring));
  return drive;
}

}  // namespace saphira::logs
