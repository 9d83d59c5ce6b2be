#include "saphira/logs/log_map.hpp"

#include <stdexcept>

#include "saphira/base/text.hpp"
#include "saphira/logs/laser_map.hpp"

namespace saphira::logs {

LogMap map_log(const DataSet& log, const std::function<bool()>& goes_on) {
  if (log.scans.empty())
    throw UnusableFile(log.name + ": it has no laser scan");
  ScanMapper mapper;
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    mapper.add(log.poses_in_odom[i], log.scans[i]);
    if (!goes_on())
      throw std::runtime_error("interrupted");
  }
  mapper.refine(2);
  LogMap result;
  result.walls = walls_of(mapper.node_scans(), mapper.nodes());
  const std::vector<Pose> poses = mapper.trajectory();
  for (std::size_t i = 0; i < poses.size(); ++i)
    result.poses.push_back({log.times[i], poses[i]});
  result.report = mapper.report();
  return result;
}

Accuracy accuracy(const std::vector<StampedPose>& poses, const Trajectory& truth) {
  constexpr double kStretch = 10.0;  // [m]
  Accuracy result;
  const Pairs pairs = pair_up(Trajectory(poses), truth);
  result.compared = pairs.estimate.size();
  if (result.compared < 2)
    return result;
  const DriftErrors errors = logs::drift(pairs, kStretch);
  result.ate = ate_rmse(pairs);
  const Pose align = alignment(pairs);
  std::size_t near = 0;
  for (std::size_t i = 0; i < pairs.estimate.size(); ++i)
    near +=
        (transform(align, pairs.estimate[i].position()) - pairs.reference[i].position()).norm() <
                kWithin
            ? 1U
            : 0U;
  result.within = static_cast<double>(near) / static_cast<double>(pairs.estimate.size());
  result.drift = errors.translation;
  result.drift_heading = errors.rotation;
  return result;
}

LogEvaluation evaluate_log(const DataSet& log, const LogMap& laser,
                           const std::vector<lps::SonarMount>& sonars, const maps::Map& map,
                           std::optional<Pose> start_in_map) {
  const Trajectory truth(laser.poses);
  LogEvaluation result;
  result.run = register_sonars(virtual_drive(log, sonars), map, start_in_map);
  result.dead_reckoning = accuracy(log.odometry.poses(), truth);
  result.localized = accuracy(result.run.poses, truth);
  result.tracked = accuracy(result.run.tracked, truth);
  return result;
}

}  // namespace saphira::logs
