#include "simulated.hpp"

#include <algorithm>

#include "saphira/base/random.hpp"
#include "saphira/sim/scene.hpp"

namespace saphira::bench {

namespace {

constexpr double kNone = 9.0;  // [m] stands for no echo: beyond all sensors' ranges

protocol::RobotParameters with_sonars(const std::vector<Pose>& poses) {
  protocol::RobotParameters parameters;
  for (std::size_t i = 0; i < poses.size(); ++i)
    parameters.sonars.push_back({static_cast<std::uint8_t>(i), poses[i]});
  return parameters;
}

// A wall along y, at that x [m].
sim::World wall_at(double x) {
  const std::string at = std::to_string(x * 1000.0);
  return sim::parse_world("width 40000 height 40000\n" + at + " 0 " + at + " 40000", "wall");
}

}  // namespace

sim::SonarModel plain_rays() {
  sim::SonarModel model;
  model.critical_angle = model.lost_angle = 0.0;
  model.strength = -100.0;
  model.roughness = 1.0;
  return model;
}

std::vector<Calibration> simulate(const std::vector<Calibration>& real,
                                  const sim::SonarModel& model, std::uint64_t seed) {
  const sim::World world = wall_at(20.0);
  sim::Scene scene(world);
  sim::Sonars sonars(scene, sim::kNobody, with_sonars({{}}), model, seed);
  std::vector<Calibration> out;
  for (const Calibration& r : real)
    out.push_back({r.truth, sonars.fire(0, {20.0 - r.truth, 20.0, 0.0}).range.value_or(kNone)});
  return out;
}

std::vector<CorridorRecord> simulate(const std::vector<CorridorRecord>& real,
                                     const Corridor& corridor, const sim::SonarModel& model,
                                     std::uint64_t seed) {
  const sim::World world = to_world(corridor);
  sim::Scene scene(world);
  std::vector<Pose> poses;
  for (const double bearing : kCorridorBearings)
    poses.push_back({0.0, 0.0, bearing});
  sim::Sonars sonars(scene, sim::kNobody, with_sonars(poses), model, seed);
  std::vector<CorridorRecord> out = real;
  for (CorridorRecord& record : out) {
    Pose pose = record.pose_in_odom;
    pose.x += kCorridorShift;
    pose.y += kCorridorShift;
    for (std::size_t i = 0; i < record.ranges.size(); ++i)
      record.ranges[i] = sonars.fire(static_cast<std::uint8_t>(i), pose).range.value_or(kNone);
  }
  return out;
}

std::vector<std::array<double, kRing>> simulate(const std::vector<std::array<double, kRing>>& real,
                                                const sim::SonarModel& model, std::uint64_t seed) {
  const sim::World world = wall_at(20.0);
  sim::Scene scene(world);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < kRing; ++i) {
    const double at = radians(15.0) * static_cast<double>(i);
    poses.push_back({kRingRadius * std::cos(at), kRingRadius * std::sin(at), at});
  }
  sim::Sonars sonars(scene, sim::kNobody, with_sonars(poses), model, seed);
  Random random(seed, 7);
  std::vector<std::array<double, kRing>> out;
  for (const auto& ring : real) {
    const double away = *std::min_element(ring.begin(), ring.end()) + kRingRadius;
    const Pose pose{20.0 - away, 20.0, radians(random.uniform(-7.5, 7.5))};
    std::array<double, kRing> simulated{};
    for (std::size_t i = 0; i < kRing; ++i)
      simulated[i] = sonars.fire(static_cast<std::uint8_t>(i), pose).range.value_or(kNone);
    out.push_back(simulated);
  }
  return out;
}

}  // namespace saphira::bench
