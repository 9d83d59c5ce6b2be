#include "saphira/lps/obstacle_memory.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::lps {
namespace {

constexpr int kFirstBelief = 3;
constexpr int kMostBelief = 6;
constexpr int kDoubtOfEcho = 2;
constexpr int kDoubtOfSilence = 1;

}  // namespace

void ObstacleMemory::echo(const Pose& sonar_in_odom, double range, std::uint64_t cycle) {
  disprove(sonar_in_odom, range - settings_.margin, kDoubtOfEcho);
  const Vec2 place = sonar_in_odom.position() + range * sonar_in_odom.direction();
  for (Obstacle& obstacle : obstacles_)
    if ((obstacle.in_odom - place).norm() <= settings_.same_place) {
      obstacle.in_odom = (obstacle.in_odom + place) / 2.0;
      obstacle.seen = cycle;
      obstacle.belief = std::min(obstacle.belief + 1, kMostBelief);
      return;
    }
  if (obstacles_.size() >= settings_.capacity)
    obstacles_.erase(
        std::min_element(obstacles_.begin(), obstacles_.end(),
                         [](const Obstacle& a, const Obstacle& b) { return a.seen < b.seen; }));
  obstacles_.push_back({place, cycle, kFirstBelief});
}

void ObstacleMemory::silence(const Pose& sonar_in_odom, double range) {
  disprove(sonar_in_odom, range, kDoubtOfSilence);
}

void ObstacleMemory::disprove(const Pose& sonar_in_odom, double range, int doubt) {
  for (Obstacle& obstacle : obstacles_) {
    const Vec2 seen = to_frame(sonar_in_odom, obstacle.in_odom);
    if (seen.norm() < range && std::abs(std::atan2(seen.y(), seen.x())) <= settings_.beam)
      obstacle.belief -= doubt;
  }
}

void ObstacleMemory::update(const Pose& robot_in_odom, std::uint64_t cycle) {
  std::erase_if(obstacles_, [&](const Obstacle& obstacle) {
    return obstacle.belief <= 0 || cycle - obstacle.seen > settings_.kept_cycles ||
           (obstacle.in_odom - robot_in_odom.position()).norm() > settings_.kept_distance;
  });
  in_robot_.clear();
  for (const Obstacle& obstacle : obstacles_)
    in_robot_.push_back(to_frame(robot_in_odom, obstacle.in_odom));
}

void ObstacleMemory::clear() {
  obstacles_.clear();
  in_robot_.clear();
}

}  // namespace saphira::lps
