#include "saphira/logs/sonar_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "saphira/interpretation/interpretation.hpp"
#include "saphira/registration/registration.hpp"

namespace saphira::logs {

SonarRun register_sonars(const SonarDrive& drive, const maps::Map& map,
                         std::optional<Pose> start_in_map) {
  using registration::State;
  interpretation::Settings seeing;
  seeing.sonars = drive.ring.mounts;
  interpretation::Interpretation interpretation(seeing);
  registration::Settings settings;
  settings.sonars = drive.ring.mounts;
  registration::Registration registration(settings, map, start_in_map);
  SonarRun out;
  const auto step = [&](std::uint64_t cycle, const Pose& pose_in_odom,
                        const std::vector<lps::SonarReading>& readings) -> const auto& {
    const auto& seen = interpretation.step({cycle, pose_in_odom, readings});
    return registration.step({cycle, 1, pose_in_odom, seen.percepts, readings});
  };
  std::uint64_t cycle = 0;
  for (std::size_t i = 0; i < drive.times.size(); ++i) {
    // Cycles of 0.1 s, by time, or more if the scans come faster. A damaged stamp may be far off.
    const double tenths = std::clamp(10.0 * (drive.times[i] - drive.times.front()), 0.0, 1e15);
    cycle = std::max(cycle + 1, static_cast<std::uint64_t>(std::llround(tenths)) + 1);
    // All readings are of this place, not of the way to it: first the way.
    step(cycle++, drive.poses_in_odom[i], {});
    const auto& placed = step(cycle, drive.poses_in_odom[i], drive.readings[i]);
    ++out.steps;
    out.lost += placed.state == State::lost ? 1U : 0U;
    out.unplaced += placed.state == State::unplaced ? 1U : 0U;
    out.accepted += static_cast<std::size_t>(
        std::count_if(placed.matches.begin(), placed.matches.end(),
                      [](const registration::Match& match) { return match.accepted; }));
    if (placed.state != State::unplaced)
      out.poses.push_back({drive.times[i], placed.pose_in_map});
    if (placed.state == State::tracking)
      out.tracked.push_back({drive.times[i], placed.pose_in_map});
  }
  return out;
}

}  // namespace saphira::logs
