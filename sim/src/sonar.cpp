#include "saphira/sim/sonar.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/sim/acoustics.hpp"

namespace saphira::sim {

namespace {

// The greatest distance of a transducer from the middle of a robot: the loader's limit is larger,
// but then only a few more segments are checked.
double farthest(const std::vector<protocol::SonarUnit>& units) {
  double far = 0.0;
  for (const auto& unit : units)
    far = std::max(far, unit.pose_in_robot.position().norm());
  return far;
}

// A surface this near before an object does not hide it [m]: it is the object's own side.
constexpr double kBefore = 0.01;

// The duration of a random change of an echo's strength.
constexpr double kLuckLasts = 0.3;  // [s]
// More standard deviations than can matter.
constexpr double kSure = 4.0;

// Numbers of fixed objects, beyond those of moving ones (Surface::id). Narrow sides of furniture
// share one.
constexpr std::uint32_t kOfCorners = 4U << 24U;
constexpr Surface kWall{0.0, false, 5U << 24U};

SonarModel with_range(SonarModel model, double range) {
  model.max_range = std::min(model.max_range, range);
  return model;
}

// Farther off the axis there is no echo.
double widest_cosine(const SonarModel& model) {
  const double most = model.strength + kSure * std::max(model.spread, model.soft_spread);
  double angle = 0.0;
  while (angle < kPi / 2.0 && 2.0 * beam_loss(angle) <= most)
    angle += radians(0.5);
  return std::max(0.0, std::cos(angle));
}

// True where the segment is so narrow that it scatters sound more than it reflects it.
bool is_strip(double squared_width, double range) {
  return squared_width < kWavelength * range;
}

}  // namespace

SonarModel in_world(SonarModel model, const SonarPlan& plan) {
  model.strength = plan.strength.value_or(model.strength);
  model.cloth = plan.cloth.value_or(model.cloth);
  model.spread = plan.spread.value_or(model.spread);
  return model;
}

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
      model_(with_range(in_world(model, scene.world().sonar), parameters.sonar_max_range)),
      min_range_(parameters.sonar_min_range),
      near_(scene.world(), model_.max_range + farthest(units_)),
      random_(seed, 2),
      crosstalk_(seed, 3),
      period_(std::max(1, static_cast<int>(std::lround(parameters.sonar_period / kTick)))),
      arrays_(std::clamp(parameters.sonar_arrays, 1, period_)),
      // Robots that are switched on together do not fire together.
      progress_(self == kNobody ? 0 : static_cast<int>(self % static_cast<RobotNumber>(period_))),
      reach_(model_.max_range + farthest(units_)),
      beam_cosine_(widest_cosine(model_)),
      direct_cosine_(std::cos(model_.direct_cone / 2.0)),
      seed_(seed) {
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
  Firing firing{number, at.position(), at.direction(), 0.0, std::nullopt};
  ++firings_;
  scene_->sound({self_, scene_->ticks(), firing.origin, firing.ahead});
  // Always the same number of draws, so that one reading does not shift those of the next.
  const bool dropped = random_.chance(model_.dropout);
  const bool rough = random_.chance(model_.roughness);
  firing.aside = random_.uniform();
  const double noise = random_.normal();
  const bool crosstalk = crosstalk_.chance(model_.crosstalk);

  gather(robot_in_world.position(), firing);
  hear_surfaces(firing);
  hear_corners(robot_in_world.position(), firing);
  for (std::size_t i = 0; i < in_beam_.discs.size(); ++i)
    hear_disc(in_beam_.things.discs[i], in_beam_.discs[i], firing);
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
  return {number, std::max(range, min_range_)};
}

// Objects before the sonar and within range.
void Sonars::gather(const Vec2& robot, const Firing& firing) {
  in_beam_.things.segments.clear();
  in_beam_.things.discs.clear();
  in_beam_.segments.clear();
  in_beam_.discs.clear();
  scene_->add_echoes(robot, reach_, self_, model_.cloth, in_beam_);
  for (const Segment& segment : near_.around(robot)) {
    const Vec2 from = segment.from - firing.origin;
    const Vec2 to = segment.to - firing.origin;
    if (from.dot(firing.ahead) >= 0.0 || to.dot(firing.ahead) >= 0.0)
      in_beam_.things.segments.push_back(segment);
  }
}

bool Sonars::is_first(const Firing& firing, const Vec2& way, double range) const {
  return range < firing.nearest.value_or(model_.max_range) &&
         (range < kBefore ||
          !cast_ray(in_beam_.things, firing.origin, way.normalized(), range - kBefore));
}

void Sonars::hear_surfaces(Firing& firing) const {
  for (std::size_t i = 0; i < in_beam_.things.segments.size(); ++i) {
    const Segment& segment = in_beam_.things.segments[i];
    const bool wall = i >= in_beam_.segments.size();
    const Surface& surface = wall ? kWall : in_beam_.segments[i];
    const Vec2 along = segment.to - segment.from;
    const double squared_width = along.squaredNorm();
    const double t = (firing.origin - segment.from).dot(along) / squared_width;
    const bool beside = t < 0.0 || t > 1.0;
    const double limit = firing.nearest.value_or(model_.max_range);
    if (beside && !is_strip(squared_width, limit))
      continue;
    const Vec2 way = segment.from + t * along - firing.origin;
    if (way.squaredNorm() >= limit * limit)
      continue;
    const double range = way.norm();
    if (is_strip(squared_width, range))
      hear_strip(segment, surface, firing);
    else if (beside)
      continue;
    else if (surface.loss > 0.0)
      hear(way, range, surface, firing, [] { return 0.0; });
    else
      hear_wall(way, range, firing);
  }
}

// A smooth surface, where it is met at a right angle.
void Sonars::hear_wall(const Vec2& way, double range, Firing& firing) const {
  const double sure = model_.critical_angle;
  const double lost = std::max(sure, model_.lost_angle - model_.lost_per_metre * range);
  const double off = sure + firing.aside * (lost - sure);
  if (way.dot(firing.ahead) >= range * std::cos(off) && is_first(firing, way, range))
    firing.nearest = range;
}

void Sonars::hear_strip(const Segment& segment, const Surface& surface, Firing& firing) const {
  const Vec2 along = segment.to - segment.from;
  const double width = along.norm();
  const Vec2 way = (segment.from + segment.to) / 2.0 - firing.origin;
  const double range = way.norm();
  if (range <= 0.0)
    return;
  const double sine = std::min(1.0, std::abs(way.dot(along)) / (range * width));
  hear(way, range, surface, firing,
       [&] { return strip_loss(width, range) + strip_lobe_loss(width, std::asin(sine)); });
}

void Sonars::hear_corners(const Vec2& robot, Firing& firing) {
  for (const Corner* corner : near_.corners_around(robot)) {
    const Vec2 way = corner->point - firing.origin;
    const double ahead = way.dot(firing.ahead);
    if (ahead <= 0.0)
      continue;
    const double range = way.norm();
    if (range >= firing.nearest.value_or(model_.max_range) || ahead <= beam_cosine_ * range)
      continue;
    const CornerShape shape = shape_from(*corner, firing.origin);
    if (shape == CornerShape::kNone)
      continue;
    const double radius = corner->arms.size() == 1 ? model_.jamb : model_.edge;
    const auto loss = [&] {
      return shape == CornerShape::kInner
                 ? strip_loss(corner->shortest, range)
                 : round_loss(std::min(radius, corner->shortest / 2.0), range);
    };
    const auto index = static_cast<std::uint32_t>(corner - scene_->world().corners.data());
    hear(way, range, {0.0, false, kOfCorners + index}, firing, loss);
  }
  for (std::size_t i = 0; i < in_beam_.segments.size(); ++i) {
    const Segment& segment = in_beam_.things.segments[i];
    Surface surface = in_beam_.segments[i];
    for (const Vec2& end : {segment.from, segment.to}) {
      ++surface.id;
      const Vec2 way = end - firing.origin;
      const double range = way.norm();
      if (range > 0.0)
        hear(way, range, surface, firing, [&] { return round_loss(model_.edge, range); });
    }
  }
}

void Sonars::hear_disc(const Disc& disc, const Surface& surface, Firing& firing) const {
  const Vec2 way = disc.centre - firing.origin;
  if (way.dot(firing.ahead) <= 0.0)
    return;
  const double range = way.norm() - disc.radius;
  if (range > 0.0)
    hear(way, range, surface, firing, [&] { return round_loss(disc.radius, range); });
}

template <class Loss>
void Sonars::hear(const Vec2& way, double range, const Surface& surface, Firing& firing,
                  const Loss& shape) const {
  const double cosine = way.dot(firing.ahead) / way.norm();
  if (cosine <= beam_cosine_ || range >= firing.nearest.value_or(model_.max_range))
    return;
  double margin = model_.strength - shape() - surface.loss - way_loss(range) -
                  2.0 * beam_loss(std::acos(std::min(1.0, cosine)));
  const double spread = surface.loss > 0.0 ? model_.soft_spread : model_.spread;
  // A swinging leg is mostly tilted away.
  if (surface.swings)
    margin = std::min(margin, 0.0);
  if (margin < -kSure * spread)
    return;
  if (margin < kSure * spread)
    margin += spread * luck(firing.number, surface.id);
  if (margin > 0.0 && is_first(firing, way, range))
    firing.nearest = range + lateness(margin);
}

double Sonars::luck(std::uint8_t number, std::uint32_t thing) const {
  const double time = static_cast<double>(firings_) * period_ * kTick / arrays_;
  const auto epoch = static_cast<std::uint64_t>(time / kLuckLasts);
  Random random(seed_ ^ epoch << 32U, static_cast<std::uint64_t>(thing) << 8U | number);
  random.next();
  return random.normal();
}

bool Sonars::in_direct_cone(const Firing& firing, const Vec2& way) const {
  const double along = way.dot(firing.ahead);
  return along >= 0.0 && along * along >= direct_cosine_ * direct_cosine_ * way.squaredNorm();
}

// The sound of other robots comes directly, so it is loud, and from half its apparent distance.
void Sonars::hear_others(Firing& firing) const {
  for (const Ping& ping : scene_->pings()) {
    const Vec2 way = ping.origin - firing.origin;
    // Most sonars look elsewhere: the cheapest test first.
    if (way.dot(ping.ahead) >= 0.0 || way.dot(firing.ahead) < 0.0 || ping.robot == self_ ||
        !in_direct_cone(firing, way))
      continue;
    const double apart = way.norm();
    // The way of the sound before this sonar began to listen.
    const double gone = static_cast<double>(scene_->ticks() - ping.tick) * kTick * kSound;
    const double range = (apart - gone) / 2.0;
    if (range < min_range_ || range >= firing.nearest.value_or(model_.max_range) ||
        -way.dot(ping.ahead) < apart * direct_cosine_)
      continue;
    // The other's sonar stands within its hull.
    const double free = apart - 2.0 * scene_->robot(ping.robot).radius();
    if (free <= 0.0 || !cast_ray(in_beam_.things, firing.origin, way / apart, free))
      firing.nearest = range;
  }
}

void Sonars::hear_rough(const Pose& at, Firing& firing) const {
  for (int i = 0; i < model_.rays; ++i) {
    const double offset =
        model_.rays == 1 ? 0.0 : model_.cone * (static_cast<double>(i) / (model_.rays - 1) - 0.5);
    const Vec2 direction(std::cos(at.th + offset), std::sin(at.th + offset));
    const auto hit = cast_ray(in_beam_.things.segments, firing.origin, direction,
                              firing.nearest.value_or(model_.max_range));
    if (hit && is_first(firing, direction, *hit))
      firing.nearest = *hit;
  }
}

}  // namespace saphira::sim
