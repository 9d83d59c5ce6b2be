#include "saphira/agent_interface/pointing.hpp"

#include <cmath>

namespace saphira::agent_interface {
namespace {

constexpr std::uint64_t kRecent = 20;       // [cycles] an arm that was lowered still counts
constexpr double kReach = 5.0;              // [m]
constexpr double kStep = 0.1;               // [m]
constexpr double kBeside = radians(45.0);   // [rad]
constexpr double kArmTurn = radians(20.0);  // [rad] so far off, a doorway counts as twice as far
constexpr auto kCorridor = lps::PointType::corridor;
constexpr auto kOffice = lps::PointType::office;

}  // namespace

std::optional<Pose> pointing(const std::vector<lps::SeenThing>& things, std::uint64_t cycle,
                             const Pose& odom_in_map, const Vec2& robot_in_map) {
  const lps::SeenThing* newest = nullptr;
  const auto away = [&](const lps::SeenThing& thing) {
    return (transform(odom_in_map, thing.pose_in_odom.position()) - robot_in_map).norm();
  };
  for (const lps::SeenThing& thing : things) {
    if (thing.pointed == 0 || thing.pointed + kRecent <= cycle)
      continue;
    if (newest == nullptr || thing.pointed > newest->pointed ||
        (thing.pointed == newest->pointed && away(thing) < away(*newest)))
      newest = &thing;
  }
  if (newest == nullptr)
    return std::nullopt;
  return compose(odom_in_map,
                 Pose(newest->pose_in_odom.x, newest->pose_in_odom.y, newest->points_in_odom));
}

const maps::Feature* doorway_at(const maps::Map& map, const Pose& arm_in_map) {
  const maps::Feature* best = nullptr;
  double least = 0.0;
  for (const maps::Feature& feature : map.features) {
    if (feature.type != lps::PointType::door)
      continue;
    const Vec2 from_person = to_frame(arm_in_map, feature.pose_in_map.position());
    const double distance = from_person.norm();
    const double off = std::abs(std::atan2(from_person.y(), from_person.x()));
    if (distance > kReach || off > kBeside)
      continue;
    const double cost = distance * (1.0 + (off / kArmTurn) * (off / kArmTurn));
    if (best != nullptr && cost >= least)
      continue;
    best = &feature;
    least = cost;
  }
  return best;
}

const maps::Feature* area_at(const maps::Map& map, const Pose& arm_in_map, bool corridors_alone) {
  const maps::Feature* best = nullptr;
  int most = 0;
  for (const maps::Feature& feature : map.features) {
    const bool fits = feature.type == kCorridor || (!corridors_alone && feature.type == kOffice);
    if (!fits || feature.width <= 0.0 || (!corridors_alone && feature.name.empty()))
      continue;
    int inside = 0;
    for (double out = 0.0; out <= kReach; out += kStep)
      inside += maps::contains(feature, transform(arm_in_map, Vec2(out, 0.0))) ? 1 : 0;
    if (inside <= most)
      continue;
    best = &feature;
    most = inside;
  }
  return best;
}

}  // namespace saphira::agent_interface
