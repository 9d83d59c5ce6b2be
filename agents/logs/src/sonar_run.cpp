#include "saphira/logs/sonar_run.hpp"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "saphira/registration/map_builder.hpp"
#include "saphira/registration/registration.hpp"

namespace saphira::logs {

namespace {

// One step after the other: `locate` gets each cycle and its percepts.
template <typename Locate>
SonarRun run(const SonarDrive& drive, Locate&& locate) {
  interpretation::Settings settings;
  settings.sonars = drive.ring.mounts;
  SonarRun out;
  std::set<std::uint32_t> known;
  const std::vector<lps::SonarReading> nothing;
  double start = cpu_seconds();
  interpretation::Interpretation interpretation(settings);
  perceive(drive, interpretation, nullptr, [&](const Perceived& seen) {
    const std::size_t i = seen.stamp;
    SonarRun uncounted;
    const std::optional<Pose> pose =
        locate(seen.complete ? out : uncounted, seen.cycle, i, seen.output->percepts,
               seen.complete ? *seen.readings : nothing);
    if (!seen.complete)
      return;
    out.step_ms.push_back(1e3 * (cpu_seconds() - start));
    start = cpu_seconds();
    ++out.steps;
    if (pose)
      out.poses.push_back({drive.times[i], *pose});
    for (const lps::Percept& percept : seen.output->percepts)
      if (known.insert(percept.id).second) {
        const bool opening =
            percept.type == lps::PointType::door || percept.type == lps::PointType::junction;
        out.walls += percept.type == lps::PointType::wall ? 1U : 0U;
        out.openings += opening ? 1U : 0U;
      }
  });
  return out;
}

}  // namespace

void perceive(const SonarDrive& drive, interpretation::Interpretation& interpretation,
              const std::vector<Pose>* odom_in_grid,
              const std::function<void(const Perceived&)>& look) {
  std::uint64_t cycle = 0;
  for (std::size_t i = 0; i < drive.times.size(); ++i) {
    // Cycles of 0.1 s, by time, or more if the readings of a place come in two of them. A damaged
    // stamp may be far off.
    const double tenths = std::clamp(10.0 * (drive.times[i] - drive.times.front()), 0.0, 1e15);
    const auto now = static_cast<std::uint64_t>(std::llround(tenths)) + 1;
    cycle = std::max(cycle + 1, now);
    const Pose grid = odom_in_grid != nullptr ? (*odom_in_grid)[i] : Pose{};
    // All readings are of this place, not of the way to it: first the way.
    if (drive.at_once) {
      const auto& moved = interpretation.step({cycle, drive.poses_in_odom[i], {}, grid});
      look({cycle++, i, &moved, &drive.readings[i], false});
    }
    const auto& seen =
        interpretation.step({cycle, drive.poses_in_odom[i], drive.readings[i], grid});
    look({cycle, i, &seen, &drive.readings[i], true});
  }
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

SonarRun register_sonars(const SonarDrive& drive, const maps::Map& map,
                         std::optional<Pose> start_in_map) {
  registration::Settings settings;
  settings.sonars = drive.ring.mounts;
  registration::Registration registration(settings, map, start_in_map);
  return run(drive,
             [&](SonarRun& out, std::uint64_t cycle, std::size_t i,
                 const std::vector<lps::Percept>& percepts,
                 const std::vector<lps::SonarReading>& readings) -> std::optional<Pose> {
               const auto& placed =
                   registration.step({cycle, 1, drive.poses_in_odom[i], percepts, readings});
               out.tracking += placed.state == registration::State::tracking ? 1U : 0U;
               out.lost += placed.state == registration::State::lost ? 1U : 0U;
               out.unplaced += placed.state == registration::State::unplaced ? 1U : 0U;
               for (const registration::Match& match : placed.matches)
                 out.accepted += match.accepted ? 1U : 0U;
               if (placed.state == registration::State::unplaced)
                 return std::nullopt;
               return placed.pose_in_map;
             });
}

SonarRun map_sonars(const SonarDrive& drive, const Pose& start_in_map) {
  registration::MapBuilderSettings settings;
  settings.sonars = drive.ring.mounts;
  registration::MapBuilder builder(settings, {}, start_in_map);
  SonarRun out =
      run(drive,
          [&](SonarRun& counts, std::uint64_t cycle, std::size_t i,
              const std::vector<lps::Percept>& percepts,
              const std::vector<lps::SonarReading>& readings) -> std::optional<Pose> {
            builder.step({cycle, 1, drive.poses_in_odom[i], percepts, readings, std::nullopt});
            ++counts.tracking;
            return builder.pose_in_map();
          });
  out.accepted = static_cast<std::size_t>(builder.closures());
  out.features = builder.map().features.size();
  return out;
}

}  // namespace saphira::logs
