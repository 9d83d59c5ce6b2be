#include "saphira/sim/sonar.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::sim {

namespace {

// The farthest that a transducer stands from the middle of a robot: the loader's limit is more, but
// then only a few segments more are looked at.
double farthest(const std::vector<protocol::SonarUnit>& units) {
  double far = 0.0;
  for (const auto& unit : units)
    far = std::max(far, unit.pose_in_robot.position().norm());
  return far;
}

// A corner is hidden by what is nearer than this before it [m]: not by the walls that make it.
constexpr double kBefore = 0.01;

SonarModel with_range(SonarModel model, double range) {
  model.max_range = std::min(model.max_range, range);
  return model;
}

}  // namespace

std::vector<std::uint8_t> default_polling(std::size_t sonars, int arrays) {
  const auto count = static_cast<std::size_t>(std::max(arrays, 1));
  const std::size_t each = (sonars + count - 1) / count;
  std::vector<std::uint8_t> sequence;
  for (std::size_t i = 0; i < each; ++i)
    for (std::size_t number = i; number < sonars; number += each)
      sequence.push_back(static_cast<std::uint8_t>(number));
  return sequence;
}

Sonars::Sonars(const Scene& scene, RobotNumber self, const protocol::RobotParameters& parameters,
               const SonarModel& model, std::uint64_t seed)
    : scene_(&scene),
      self_(self),
      units_(parameters.sonars),
      model_(with_range(model, parameters.sonar_max_range)),
      near_(scene.world(), model_.max_range + farthest(units_)),
      random_(seed, 2),
      period_(std::max(1, static_cast<int>(std::lround(parameters.sonar_period / kTick)))),
      arrays_(std::clamp(parameters.sonar_arrays, 1, period_)),
      reach_(model_.max_range + farthest(units_)) {
  set_default_polling();
}

void Sonars::set_polling(const std::vector<std::uint8_t>& sequence) {
  sequence_.clear();
  for (const std::uint8_t number : sequence)
    if (number < units_.size())
      sequence_.push_back(number);
  next_ = 0;
}

void Sonars::set_default_polling() {
  set_polling(default_polling(units_.size(), arrays_));
}

std::optional<SonarEcho> Sonars::tick(const Pose& robot_in_world) {
  progress_ += arrays_;
  if (progress_ < period_)
    return std::nullopt;
  progress_ -= period_;
  if (sequence_.empty())
    return std::nullopt;
  const std::uint8_t number = sequence_[next_];
  next_ = (next_ + 1) % sequence_.size();
  return fire(number, robot_in_world);
}

SonarEcho Sonars::fire(std::uint8_t number, const Pose& robot_in_world) {
  const Pose at = compose(robot_in_world, units_[number].pose_in_robot);
  // Always the same draws, so that one reading's fate does not shift those of the next.
  const bool dropped = random_.chance(model_.dropout);
  const bool glancing_lost = random_.chance(model_.specular_loss);
  const bool corners_lost = random_.chance(model_.corner_loss);
  const double noise = random_.normal();

  // Only segments that reach into the half-plane ahead, and into the beam's circle.
  const Vec2 ahead = at.direction();
  const Vec2 origin = at.position();
  in_beam_.segments.clear();
  in_beam_.discs.clear();
  scene_->add_movable(robot_in_world.position(), reach_, self_, in_beam_);
  const std::size_t movable = in_beam_.segments.size();
  for (const Segment& segment : near_.around(robot_in_world.position())) {
    if ((segment.from - origin).dot(ahead) > 0.0 || (segment.to - origin).dot(ahead) > 0.0)
      in_beam_.segments.push_back(segment);
  }

  std::optional<double> nearest;
  for (int i = 0; i < model_.rays; ++i) {
    const double offset =
        model_.rays == 1 ? 0.0 : model_.cone * (static_cast<double>(i) / (model_.rays - 1) - 0.5);
    const Vec2 direction(std::cos(at.th + offset), std::sin(at.th + offset));
    const auto hit = cast_ray(in_beam_, origin, direction, model_.max_range);
    if (!hit || (glancing_lost && hit->incidence > model_.critical_angle))
      continue;
    if (!nearest || hit->range < *nearest)
      nearest = hit->range;
  }
  if (!corners_lost) {
    for (const Corner* corner : near_.corners_around(robot_in_world.position()))
      if (is_sharp_from(*corner, origin))
        hear_corner(corner->point, origin, ahead, nearest);
    for (std::size_t i = 0; i < movable; ++i) {
      hear_corner(in_beam_.segments[i].from, origin, ahead, nearest);
      hear_corner(in_beam_.segments[i].to, origin, ahead, nearest);
    }
  }
  if (!nearest || dropped)
    return {number, std::nullopt};
  const double range = *nearest + noise * (model_.noise + model_.relative_noise * *nearest);
  if (range >= model_.max_range)
    return {number, std::nullopt};
  return {number, std::max(range, model_.min_range)};
}

// Takes the corner for the nearest echo, if it is one.
void Sonars::hear_corner(const Vec2& corner, const Vec2& origin, const Vec2& ahead,
                         std::optional<double>& nearest) const {
  const Vec2 way = corner - origin;
  const double range = way.norm();
  if (range < kBefore || range > nearest.value_or(model_.max_range) ||
      way.dot(ahead) < range * std::cos(model_.corner_cone / 2))
    return;
  if (!cast_ray(in_beam_, origin, way / range, range - kBefore))
    nearest = range;
}

}  // namespace saphira::sim
