#include "saphira/sim/scene.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace saphira::sim {

Robot& Scene::add_robot(const protocol::RobotParameters& parameters, const Pose& start_in_world,
                        std::uint64_t seed) {
  const double free = distance(start_in_world.position());
  if (free < parameters.radius)
    throw std::invalid_argument("the robot would stand in a wall: the nearest thing is " +
                                std::to_string(free) + " m from its middle, its radius is " +
                                std::to_string(parameters.radius) + " m");
  hulls_.push_back({start_in_world.position(), parameters.radius});
  robots_.push_back(
      std::make_unique<Robot>(*this, robots_.size(), parameters, start_in_world, seed));
  fastest_ = std::max(fastest_, robots_.back()->fastest());
  return *robots_.back();
}

void Scene::tick() {
  ++ticks_;
  for (const auto& robot : robots_)
    robot->tick();
}

void Scene::moved(RobotNumber number) {
  hulls_[number].centre = robots_[number]->pose_in_world().position();
}

void Scene::add_movable(const Vec2& point, double reach, RobotNumber but, Things& things) const {
  for (std::size_t i = 0; i < hulls_.size(); ++i) {
    const double far = reach + hulls_[i].radius;
    if (i != but && (hulls_[i].centre - point).squaredNorm() <= far * far)
      things.discs.push_back(hulls_[i]);
  }
}

double Scene::distance(const Vec2& point, RobotNumber but) const {
  double best = sim::distance(world_->segments, point);
  for (std::size_t i = 0; i < hulls_.size(); ++i)
    if (i != but)
      best = std::min(best, (hulls_[i].centre - point).norm() - hulls_[i].radius);
  return best;
}

}  // namespace saphira::sim
