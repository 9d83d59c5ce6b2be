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

// What stands nearer than this before a thing hides it [m]: not its own sides.
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
  Firing firing{at.position(), at.direction(), 0.0, std::nullopt};
  // Always the same draws, so that one reading's fate does not shift those of the next.
  const bool dropped = random_.chance(model_.dropout);
  const bool rough = random_.chance(model_.roughness);
  const bool corners_lost = random_.chance(model_.corner_loss);
  firing.aside = random_.uniform();
  const double noise = random_.normal();

  // Only segments that reach into the half-plane ahead, and into the beam's circle.
  in_beam_.segments.clear();
  in_beam_.discs.clear();
  scene_->add_movable(robot_in_world.position(), reach_, self_, in_beam_);
  const std::size_t movable = in_beam_.segments.size();
  for (const Segment& segment : near_.around(robot_in_world.position())) {
    if ((segment.from - firing.origin).dot(firing.ahead) > 0.0 ||
        (segment.to - firing.origin).dot(firing.ahead) > 0.0)
      in_beam_.segments.push_back(segment);
  }

  hear_surfaces(firing);
  if (!corners_lost) {
    for (const Corner* corner : near_.corners_around(robot_in_world.position()))
      if (is_sharp_from(*corner, firing.origin))
        hear_corner(corner->point, 0.0, firing);
    for (std::size_t i = 0; i < movable; ++i) {
      hear_corner(in_beam_.segments[i].from, 0.0, firing);
      hear_corner(in_beam_.segments[i].to, 0.0, firing);
    }
    for (const Disc& disc : in_beam_.discs)
      hear_corner(disc.centre, disc.radius, firing);
  }
  if (rough)
    hear_rough(at, firing);

  if (!firing.nearest || dropped)
    return {number, std::nullopt};
  const double range =
      *firing.nearest + noise * (model_.noise + model_.relative_noise * *firing.nearest);
  if (range >= model_.max_range)
    return {number, std::nullopt};
  return {number, std::max(range, model_.min_range)};
}

bool Sonars::is_first(const Firing& firing, const Vec2& way, double range) const {
  return range < firing.nearest.value_or(model_.max_range) &&
         (range < kBefore || !cast_ray(in_beam_, firing.origin, way.normalized(), range - kBefore));
}

// Every surface where it is met at a right angle.
void Sonars::hear_surfaces(Firing& firing) const {
  const double sure = model_.critical_angle;
  for (const Segment& segment : in_beam_.segments) {
    const Vec2 along = segment.to - segment.from;
    const double t = (firing.origin - segment.from).dot(along) / along.squaredNorm();
    if (t < 0.0 || t > 1.0)
      continue;
    const Vec2 way = segment.from + t * along - firing.origin;
    const double range = way.norm();
    if (range >= firing.nearest.value_or(model_.max_range))
      continue;
    const double lost = std::max(sure, model_.lost_angle - model_.lost_per_metre * range);
    const double off = sure + firing.aside * (lost - sure);
    if (way.dot(firing.ahead) >= range * std::cos(off) && is_first(firing, way, range))
      firing.nearest = range;
  }
}

// A corner, or a round thing about it.
void Sonars::hear_corner(const Vec2& corner, double radius, Firing& firing) const {
  const Vec2 way = corner - firing.origin;
  const double middle = way.norm();
  const double range = middle - radius;
  if (range > 0.0 && way.dot(firing.ahead) >= middle * std::cos(model_.corner_cone / 2) &&
      is_first(firing, way, range))
    firing.nearest = range;
}

void Sonars::hear_rough(const Pose& at, Firing& firing) const {
  for (int i = 0; i < model_.rays; ++i) {
    const double offset =
        model_.rays == 1 ? 0.0 : model_.cone * (static_cast<double>(i) / (model_.rays - 1) - 0.5);
    const Vec2 direction(std::cos(at.th + offset), std::sin(at.th + offset));
    const auto hit =
        cast_ray(in_beam_, firing.origin, direction, firing.nearest.value_or(model_.max_range));
    if (hit)
      firing.nearest = hit->range;
  }
}

}  // namespace saphira::sim
