#include "sonar_run.hpp"

#include <chrono>
#include <cmath>
#include <set>

#include "saphira/interpretation/interpretation.hpp"
#include "saphira/registration/registration.hpp"

namespace saphira::bench {

SonarRun register_sonars(const SonarDrive& drive, const maps::Map& map,
                         std::optional<Pose> start_in_map) {
  interpretation::Settings seen_by;
  seen_by.sonars = drive.ring.mounts;
  interpretation::Interpretation interpretation(seen_by);
  registration::Settings settings;
  settings.sonars = drive.ring.mounts;
  registration::Registration registration(settings, map, start_in_map);
  SonarRun run;
  std::set<std::uint32_t> known;
  std::uint64_t cycle = 0;
  for (std::size_t i = 0; i < drive.times.size(); ++i) {
    // Cycles of 0.1 s, as time goes.
    const auto now =
        static_cast<std::uint64_t>(std::llround(10.0 * (drive.times[i] - drive.times.front()))) + 1;
    cycle = std::max(cycle + 1, now);
    const auto start = std::chrono::steady_clock::now();
    const auto& seen = interpretation.step({cycle, drive.poses_in_odom[i], drive.readings[i]});
    const auto& placed =
        registration.step({cycle, 1, drive.poses_in_odom[i], seen.percepts, drive.readings[i]});
    run.step_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
            .count());
    ++run.steps;
    run.tracking += placed.state == registration::State::tracking ? 1U : 0U;
    run.lost += placed.state == registration::State::lost ? 1U : 0U;
    run.unplaced += placed.state == registration::State::unplaced ? 1U : 0U;
    for (const registration::Match& match : placed.matches)
      run.accepted += match.accepted ? 1U : 0U;
    for (const lps::Percept& percept : seen.percepts)
      if (known.insert(percept.id).second) {
        run.walls += percept.type == lps::PointType::wall ? 1U : 0U;
        run.openings +=
            percept.type == lps::PointType::door || percept.type == lps::PointType::junction ? 1U
                                                                                             : 0U;
      }
    if (placed.state != registration::State::unplaced)
      run.poses.push_back({drive.times[i], placed.pose_in_map});
  }
  return run;
}

}  // namespace saphira::bench
