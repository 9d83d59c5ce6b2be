#include "saphira/registration/matching.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::registration {
namespace {

using lps::Percept;
using lps::PointType;

struct Candidate {
  std::size_t feature = 0;
  Eigen::Vector2d innovation{0.0, 0.0};
  Eigen::Matrix<double, 2, 4> jacobian = Eigen::Matrix<double, 2, 4>::Zero();
  Eigen::Matrix2d noise = Eigen::Matrix2d::Identity();
  double distance = 0.0;
  Vec2 correction{0.0, 0.0};  // of the pose, at the percept
  double turned = 0.0;
};

/// The angle between two lines: modulo half a turn.
double turned_line(double a, double b) {
  const double turned = norm2_angle(a - b);
  return std::abs(turned) <= kPi / 2 ? turned : norm2_angle(turned + kPi);
}

class Matcher {
 public:
  Matcher(const Percept& percept, const Pose& robot_in_odom, const MatchSettings& settings,
          const PoseFilter& filter)
      : percept_(percept), settings_(settings), filter_(filter), robot_(filter.pose()) {
    seen_ = compose(robot_, relative(robot_in_odom, percept.pose_in_odom));
    reach_ = 3.0 * filter.sigma_position() + 0.5;
  }

  const Pose& seen() const { return seen_; }
  double reach() const { return reach_; }
  const Pose& robot() const { return robot_; }
  const std::vector<Candidate>& candidates() const { return candidates_; }

  /// A line of the map through `point` along `heading`.
  void offer_line(std::size_t feature, const Vec2& point, double heading) {
    const double turned = turned_line(seen_.th, heading);
    if (std::abs(turned) > settings_.most_turned)
      return;
    const Vec2 normal{-std::sin(heading), std::cos(heading)};
    const double across = (seen_.position() - point).dot(normal);
    if (std::abs(across) > reach_)
      return;
    Candidate c{.feature = feature, .innovation = {-across, -turned}};
    const Vec2 arm = seen_.position() - robot_.position();
    c.jacobian(0, 0) = normal.x();
    c.jacobian(0, 1) = normal.y();
    c.jacobian(0, 2) = normal.dot(Vec2(-arm.y(), arm.x()));
    c.jacobian(1, 2) = 1.0;
    c.noise(0, 0) = square(percept_.sigma_across) + square(settings_.map_error);
    c.noise(1, 1) = square(percept_.sigma_heading) + square(settings_.map_heading);
    c.correction = -across * normal;
    c.turned = turned;
    add(c);
  }

  /// A point of the map.
  void offer_point(std::size_t feature, const Vec2& point) {
    const Vec2 off = seen_.position() - point;
    if (off.norm() > reach_)
      return;
    Candidate c{.feature = feature, .innovation = -off};
    const Vec2 arm = seen_.position() - robot_.position();
    c.jacobian.leftCols<2>().setIdentity();
    c.jacobian(0, 2) = -arm.y();
    c.jacobian(1, 2) = arm.x();
    const Vec2 along = seen_.direction();
    const Vec2 across{-along.y(), along.x()};
    c.noise =
        (square(percept_.sigma_along) + square(settings_.map_error)) * along * along.transpose() +
        (square(percept_.sigma_across) + square(settings_.map_error)) * across * across.transpose();
    c.correction = -off;
    add(c);
  }

 private:
  static double square(double x) { return x * x; }
  void add(Candidate& c) {
    c.distance = filter_.distance<2>(c.innovation, c.jacobian, c.noise);
    candidates_.push_back(c);
  }

  const Percept& percept_;
  const MatchSettings& settings_;
  const PoseFilter& filter_;
  Pose robot_;
  Pose seen_;
  double reach_ = 0.0;
  std::vector<Candidate> candidates_;
};

void find_walls(const Percept& percept, const LineMap& lines, Matcher& matcher) {
  const Vec2 half = matcher.seen().direction() * percept.length / 2.0;
  for (const Surface& surface : lines.surfaces()) {
    if (surface.length < 0.4)
      continue;
    const Vec2 way = (surface.to - surface.from) / surface.length;
    const double a = (matcher.seen().position() - half - surface.from).dot(way);
    const double b = (matcher.seen().position() + half - surface.from).dot(way);
    const double overlap = std::min(std::max(a, b), surface.length) - std::max(std::min(a, b), 0.0);
    if (overlap < std::min(0.5 * percept.length, 0.5) - (matcher.reach() - 0.5))
      continue;
    // The back of a wall cannot be seen.
    if ((matcher.robot().position() - surface.from).dot(surface.free) < -matcher.reach() + 0.3 &&
        surface.free != Vec2(0.0, 0.0))
      continue;
    matcher.offer_line(surface.feature, surface.from, surface.heading);
  }
}

void find_corridors(const Percept& percept, const maps::Map& map, const MatchSettings& settings,
                    Matcher& matcher) {
  for (std::size_t i = 0; i < map.features.size(); ++i) {
    const maps::Feature& feature = map.features[i];
    if (feature.type != PointType::corridor ||
        std::abs(feature.width - percept.width) > settings.corridor_width)
      continue;
    const Pose off = relative(feature.pose_in_map, matcher.seen());
    if (std::abs(off.x) > feature.length / 2.0 + matcher.reach())
      continue;
    matcher.offer_line(i, feature.pose_in_map.position(), feature.pose_in_map.th);
  }
}

void find_openings(const Percept& percept, const LineMap& lines, const MatchSettings& settings,
                   Matcher& matcher) {
  for (const Opening& opening : lines.openings()) {
    if (std::abs(opening.width - percept.width) > settings.width ||
        std::abs(norm2_angle(matcher.seen().th - opening.pose_in_map.th)) > settings.most_turned)
      continue;
    matcher.offer_point(opening.feature, opening.pose_in_map.position());
  }
}

void find_ends(const LineMap& lines, const MatchSettings& settings, Matcher& matcher) {
  for (const Surface& surface : lines.surfaces()) {
    const double normal = surface.heading + kPi / 2;
    if (std::abs(turned_line(matcher.seen().th, normal)) > settings.most_turned)
      continue;
    if (surface.free != Vec2(0.0, 0.0) && matcher.seen().direction().dot(surface.free) < 0.0)
      continue;
    if (surface.from_is_end)
      matcher.offer_point(surface.feature, surface.from);
    if (surface.to_is_end)
      matcher.offer_point(surface.feature, surface.to);
  }
}

}  // namespace

Match match(const Percept& percept, const Pose& robot_in_odom, const maps::Map& map,
            const LineMap& lines, const MatchSettings& settings, PoseFilter& filter) {
  Matcher matcher(percept, robot_in_odom, settings, filter);
  switch (percept.type) {
    case PointType::wall:
      find_walls(percept, lines, matcher);
      break;
    case PointType::corridor:
      find_corridors(percept, map, settings, matcher);
      break;
    case PointType::door:
    case PointType::junction:
      find_openings(percept, lines, settings, matcher);
      break;
    case PointType::breach:
      find_ends(lines, settings, matcher);
      break;
    default:
      break;
  }
  Match result;
  result.percept = percept.id;
  const Candidate* best = nullptr;
  for (const Candidate& c : matcher.candidates())
    if (best == nullptr || c.distance < best->distance)
      best = &c;
  if (best == nullptr) {
    result.reason = "nothing of the kind is near";
    return result;
  }
  result.feature = best->feature;
  result.artifact = map.features[best->feature].id;
  result.offset = -best->correction;
  result.turned = best->turned;
  result.distance = best->distance;
  if (best->distance > settings.gate || best->correction.norm() > settings.most_off) {
    result.reason = "too far from where the nearest is expected";
    return result;
  }
  result.ambiguous = std::any_of(
      matcher.candidates().begin(), matcher.candidates().end(), [&](const Candidate& c) {
        return c.distance < settings.ambiguity &&
               ((c.correction - best->correction).norm() > settings.same_innovation ||
                std::abs(c.turned - best->turned) > settings.same_heading);
      });
  if (result.ambiguous) {
    result.reason = "could be another one as well";
    return result;
  }
  filter.correct<2>(best->innovation, best->jacobian, best->noise);
  result.accepted = true;
  return result;
}

}  // namespace saphira::registration
