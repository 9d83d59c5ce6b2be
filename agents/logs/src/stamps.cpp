#include "saphira/logs/stamps.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace saphira::logs {

namespace {

using Key = std::vector<int>;

Key key_of(const LaserScan& scan) {
  Key key;
  key.reserve(scan.ranges.size());
  for (const double range : scan.ranges)
    key.push_back(static_cast<int>(std::lround(std::min(range, 1000.0) * 100.0)));
  return key;
}

// Scans in both the corrected file and the raw log: index there by index here, in order.
std::vector<std::optional<std::size_t>> common(const CarmenLog& raw, const CarmenLog& corrected) {
  std::map<Key, std::vector<std::size_t>> by_ranges;
  for (std::size_t i = 0; i < raw.scans.size(); ++i)
    by_ranges[key_of(raw.scans[i])].push_back(i);
  std::vector<std::optional<std::size_t>> out;
  std::size_t last = 0;
  for (const LaserScan& scan : corrected.scans) {
    out.emplace_back();
    const auto found = by_ranges.find(key_of(scan));
    if (found == by_ranges.end())
      continue;
    const auto next = std::lower_bound(found->second.begin(), found->second.end(), last);
    if (next == found->second.end())
      continue;
    last = *next;
    out.back() = *next;
  }
  return out;
}

// Gives the scans, which are in order, the stamps at which dead reckoning had their poses: the best
// assignment that keeps the order.
void put_in_time(const std::vector<LaserScan*>& scans, const Trajectory& odometry) {
  constexpr double kTick = 0.02;        // [s]
  constexpr int kReach = 60;            // ticks to each side of the stamp
  constexpr double kPerSecond = 0.002;  // cost of a deviation from the stamp itself
  if (scans.empty())
    return;
  struct Row {
    int first = 0;             // tick of the first candidate
    std::vector<double> cost;  // of all scans up to this one, this one at the candidate's tick
    std::vector<int> best;     // the cheapest candidate so far
  };
  const double start = scans.front()->time.ipc;
  std::vector<Row> rows;
  for (const LaserScan* scan : scans) {
    Row row;
    row.first = static_cast<int>(std::lround((scan->time.ipc - start) / kTick)) - kReach;
    for (int k = 0; k <= 2 * kReach; ++k) {
      const double time = start + kTick * (row.first + k);
      double cost = 10.0;
      if (const auto pose = odometry.at(time)) {
        const Pose off = relative(*pose, scan->pose);
        cost = std::hypot(off.x, off.y) + 0.5 * std::abs(off.th) +
               kPerSecond * std::abs(time - scan->time.ipc);
      }
      if (!rows.empty()) {
        const Row& before = rows.back();
        const int last = std::min(row.first + k - before.first, 2 * kReach);
        cost +=
            last < 0
                ? 1e6
                : before
                      .cost[static_cast<std::size_t>(before.best[static_cast<std::size_t>(last)])];
      }
      row.cost.push_back(cost);
      const bool better = k == 0 || cost < row.cost[static_cast<std::size_t>(row.best.back())];
      row.best.push_back(better ? k : row.best.back());
    }
    rows.push_back(std::move(row));
  }
  int limit = rows.back().first + 2 * kReach;
  for (std::size_t i = scans.size(); i-- > 0;) {
    const Row& row = rows[i];
    const int last = std::clamp(limit - row.first, 0, 2 * kReach);
    limit = row.first + row.best[static_cast<std::size_t>(last)];
    scans[i]->time.ipc = scans[i]->time.logger = start + kTick * limit;
  }
}

}  // namespace

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

TimeBase time_base(const CarmenLog& raw, Clock clock) {
  std::vector<StampedPose> poses;
  for (const LaserScan& scan : raw.scans)
    poses.push_back({time_of(scan.time, clock), scan.pose});
  for (const OdomRecord& record : raw.odometry)
    poses.push_back({time_of(record.time, clock), record.pose});
  return {Trajectory(std::move(poses)), 0};
}

std::optional<double> clock_offset(const CarmenLog& raw, Clock clock, const CarmenLog& corrected) {
  const auto pairs = common(raw, corrected);
  std::vector<double> offsets;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (pairs[k])
      offsets.push_back(time_of(raw.scans[*pairs[k]].time, clock) - corrected.scans[k].time.ipc);
  if (offsets.empty())
    return std::nullopt;
  return spread_of(offsets).median;
}

TimeBase mend_stamps(CarmenLog& raw, const CarmenLog& corrected) {
  const auto pairs = common(raw, corrected);
  const double offset = clock_offset(raw, Clock::ipc, corrected).value_or(0.0);
  std::vector<StampedPose> track;
  std::vector<char> original(raw.scans.size(), 0);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (!pairs[k])
      continue;
    original[*pairs[k]] = 1;
    track.push_back({raw.scans[*pairs[k]].time.ipc, raw.scans[*pairs[k]].pose});
  }
  for (const OdomRecord& record : corrected.odometry) {
    if (record.scans_before == 0 || !pairs[record.scans_before - 1])
      continue;
    const LaserScan& before = corrected.scans[record.scans_before - 1];
    // The first line after a scan repeats it, without a stamp.
    if (record.time.ipc <= before.time.ipc)
      continue;
    track.push_back(
        {record.time.ipc + offset, compose(raw.scans[*pairs[record.scans_before - 1]].pose,
                                           relative(before.pose, record.pose))});
  }
  Trajectory odometry(std::move(track));
  std::vector<LaserScan*> lost;
  for (std::size_t i = 0; i < raw.scans.size(); ++i)
    if (original[i] == 0)
      lost.push_back(&raw.scans[i]);
  put_in_time(lost, odometry);
  const std::size_t mended = lost.size();
  std::stable_sort(raw.scans.begin(), raw.scans.end(),
                   [](const LaserScan& a, const LaserScan& b) { return a.time.ipc < b.time.ipc; });
  return {std::move(odometry), mended};
}

}  // namespace saphira::logs
