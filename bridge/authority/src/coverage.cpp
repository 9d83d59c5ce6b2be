#include "saphira/authority/coverage.hpp"

#include <cmath>
#include <limits>

namespace saphira::authority {

namespace {

constexpr std::uint64_t kLately = 40;  // [cycles] after them somebody else may stand there
// [m] The lobes of neighbours diverge before they overlap. A robot that begins to drive is slow
// there.
constexpr double kFrom = 0.35;
constexpr double kStep = 0.1;     // [m] between spots along the path
constexpr double kAcross = 0.05;  // [m] between spots across it: the radius of a post
constexpr double kBeside = radians(20.0);
constexpr double kWidest = radians(20.0);
constexpr double kOverlap = radians(1.5);
const double kTangent = std::tan(kLobe);
constexpr double kNear = 0.03;  // [m] a near post has a stronger echo, so the lobe begins wider

}  // namespace

void Coverage::update(std::uint64_t cycle, const Pose& robot_in_odom,
                      const std::vector<Reading>& readings) {
  robot_in_odom_ = robot_in_odom;
  while (!lobes_.empty() && lobes_.back().cycle + kLately < cycle)
    lobes_.pop_back();
  for (const Reading& reading : readings)
    lobes_.push_front({ToFrame(compose(robot_in_odom, reading.sonar_in_robot)),
                       std::min(reading.range.value_or(range_), range_), cycle});
}

inline bool Coverage::covers(const Lobe& lobe, const Vec2& spot_in_odom) {
  const Vec2 spot = lobe.to_sonar(spot_in_odom);
  return spot.x() > 0.0 && std::abs(spot.y()) <= spot.x() * kTangent + kNear &&
         spot.squaredNorm() <= lobe.range * lobe.range;
}

double Coverage::way(bool forward) const {
  if (range_ <= kFrom)
    return std::numeric_limits<double>::infinity();
  const double side = forward ? 1.0 : -1.0;
  const int across = static_cast<int>(std::ceil(radius_ / kAcross));
  const int steps = static_cast<int>(std::ceil((range_ - kFrom) / kStep));
  const Vec2 ahead = robot_in_odom_.direction();
  // The lobe of a spot often covers the next one, too.
  auto lobe = lobes_.begin();
  for (int step = 0; step < steps; ++step) {
    const double free = kFrom + kStep * step;
    const double along = side * (radius_ + free);
    const double x = robot_in_odom_.x + ahead.x() * along;
    const double y = robot_in_odom_.y + ahead.y() * along;
    for (int i = -across; i <= across; ++i) {
      const double aside = radius_ * i / across;
      const Vec2 in_odom(x - ahead.y() * aside, y + ahead.x() * aside);
      if (lobe != lobes_.end() && covers(*lobe, in_odom))
        continue;
      lobe = std::find_if(lobes_.begin(), lobes_.end(),
                          [&](const Lobe& each) { return covers(each, in_odom); });
      if (lobe == lobes_.end())
        return free;
    }
  }
  return range_;
}

double swing(const std::vector<protocol::SonarUnit>& sonars, bool forward) {
  std::vector<double> axes;  // from the right to the left of the way
  axes.reserve(sonars.size());
  for (const protocol::SonarUnit& sonar : sonars)
    axes.push_back(norm2_angle(sonar.pose_in_robot.th - (forward ? 0.0 : kPi)));
  std::sort(axes.begin(), axes.end());
  double widest = 0.0;
  for (std::size_t i = 1; i < axes.size(); ++i) {
    const double right = axes[i - 1] + kLobe;
    const double left = axes[i] - kLobe;
    if (left > -kBeside && right < kBeside)
      widest = std::max(widest, left - right);
  }
  return widest <= 0.0 || widest > kWidest ? 0.0 : 0.5 * widest + kOverlap;
}

}  // namespace saphira::authority
