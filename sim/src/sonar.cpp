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

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

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

Sonars::Sonars(Scene& scene, RobotNumber self, const protocol::RobotParameters& parameters,
               const SonarModel& model, std::uint64_t seed)
    : scene_(&scene),
      self_(self),
      units_(parameters.sonars),
      model_(with_range(model, parameters.sonar_max_range)),
      near_(scene.world(), model_.max_range + farthest(units_)),
      random_(seed, 2),
      crosstalk_(seed, 3),
      period_(std::max(1, static_cast<int>(std::lround(parameters.sonar_period / kTick)))),
      arrays_(std::clamp(parameters.sonar_arrays, 1, period_)),
      // Robots that are switched on together do not fire together.
      progress_(self == kNobody ? 0 : static_cast<int>(self % static_cast<RobotNumber>(period_))),
      reach_(model_.max_range + farthest(units_)),
      corner_cosine_(std::cos(model_.corner_cone / 2.0)) {
  const double widest = std::max({model_.lost_angle, model_.corner_cone / 2.0, model_.cone / 2.0});
  // A wider one is taken for a half-plane.
  if (widest < radians(89.0))
    widest_ = {std::cos(widest), std::sin(widest)};
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
  scene_->sound({self_, scene_->ticks(), firing.origin, firing.ahead});
  // Always the same draws, so that one reading's fate does not shift those of the next.
  const bool dropped = random_.chance(model_.dropout);
  const bool rough = random_.chance(model_.roughness);
  const bool corners_lost = random_.chance(model_.corner_loss);
  firing.aside = random_.uniform();
  const double noise = random_.normal();
  const bool crosstalk = crosstalk_.chance(model_.crosstalk);

  // Only what reaches into the widest sector that is listened to.
  const Vec2& ahead = firing.ahead;
  const Vec2 aside(-ahead.y() * widest_.y(), ahead.x() * widest_.y());
  const Vec2 leftmost = widest_.x() * ahead + aside;
  const Vec2 rightmost = widest_.x() * ahead - aside;
  in_beam_.segments.clear();
  in_beam_.discs.clear();
  scene_->add_movable(robot_in_world.position(), reach_, self_, in_beam_);
  const std::size_t movable = in_beam_.segments.size();
  for (const Segment& segment : near_.around(robot_in_world.position())) {
    const Vec2 from = segment.from - firing.origin;
    const Vec2 to = segment.to - firing.origin;
    if ((cross(leftmost, from) > 0.0 && cross(leftmost, to) > 0.0) ||
        (cross(rightmost, from) < 0.0 && cross(rightmost, to) < 0.0) ||
        (from.dot(ahead) < 0.0 && to.dot(ahead) < 0.0))
      continue;
    in_beam_.segments.push_back(segment);
  }

  hear_surfaces(firing);
  if (!corners_lost) {
    for (const Corner* corner : near_.corners_around(robot_in_world.position()))
      if (in_corner_cone(firing, corner->point - firing.origin) &&
          is_sharp_from(*corner, firing.origin))
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

  const auto heard = firing.nearest;
  if (crosstalk && arrays_ > 1 && before_ && *before_ < firing.nearest.value_or(model_.max_range))
    firing.nearest = before_;
  before_ = heard;
  hear_others(firing);

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
  if (range > 0.0 && in_corner_cone(firing, way) && is_first(firing, way, range))
    firing.nearest = range;
}

bool Sonars::in_corner_cone(const Firing& firing, const Vec2& way) const {
  const double along = way.dot(firing.ahead);
  return along >= 0.0 && along * along >= corner_cosine_ * corner_cosine_ * way.squaredNorm();
}

// What other robots send comes straight, so it is loud, and from half as far as it seems.
void Sonars::hear_others(Firing& firing) const {
  for (const Ping& ping : scene_->pings()) {
    const Vec2 way = ping.origin - firing.origin;
    if (ping.robot == self_ || !in_corner_cone(firing, way))
      continue;
    const double apart = way.norm();
    // How far the sound was on its way when this sonar began to listen.
    const double gone = static_cast<double>(scene_->ticks() - ping.tick) * kTick * kSound;
    const double range = (apart - gone) / 2.0;
    if (range < model_.min_range || range >= firing.nearest.value_or(model_.max_range) ||
        -way.dot(ping.ahead) < apart * corner_cosine_)
      continue;
    // The other's sonar stands within its hull.
    const double free = apart - 2.0 * scene_->robot(ping.robot).radius();
    if (free <= 0.0 || !cast_ray(in_beam_, firing.origin, way / apart, free))
      firing.nearest = range;
  }
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
