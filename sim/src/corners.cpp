#include "saphira/sim/corners.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/sim/world.hpp"

namespace saphira::sim {

namespace {

constexpr double kSame = 0.002;            // [m]
constexpr double kFlat = radians(5.0);     // a wall with a smaller turn goes straight on
constexpr double kSquare = radians(2.0);   // an inner corner with a larger deviation is no mirror
constexpr double kSameArm = radians(1.0);  // walls that lie upon each other

bool before(const Vec2& a, const Vec2& b) {
  return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
}

// The first corner with at least this x.
std::vector<Corner>::iterator first_from(std::vector<Corner>& corners, double x) {
  return std::ranges::lower_bound(corners, x, {},
                                  [](const Corner& corner) { return corner.point.x(); });
}

void add_arm(Corner& corner, const Vec2& towards) {
  corner.arms.push_back(
      norm_angle(std::atan2(towards.y() - corner.point.y(), towards.x() - corner.point.x())));
}

void tidy(std::vector<double>& arms) {
  std::ranges::sort(arms);
  std::vector<double> kept;
  for (const double arm : arms)
    if (kept.empty() || arm - kept.back() > kSameArm)
      kept.push_back(arm);
  if (kept.size() > 1 && kept.front() + 2.0 * kPi - kept.back() <= kSameArm)
    kept.pop_back();
  arms = std::move(kept);
}

bool is_flat(double sector) {
  return std::abs(sector - kPi) < kFlat;
}

}  // namespace

std::vector<Corner> find_corners(const std::vector<Segment>& segments) {
  std::vector<Vec2> ends;
  for (const Segment& segment : segments) {
    ends.push_back(segment.from);
    ends.push_back(segment.to);
  }
  std::ranges::sort(ends, before);
  std::vector<Corner> corners;  // by x
  for (const Vec2& end : ends) {
    const auto near = [&](const Corner& c) { return (c.point - end).norm() <= kSame; };
    if (std::none_of(first_from(corners, end.x() - kSame), corners.end(), near))
      corners.push_back({end, {}, 0.0});
  }
  for (const Segment& segment : segments) {
    const auto [low, high] = std::minmax(segment.from.x(), segment.to.x());
    for (auto corner = first_from(corners, low - kSame);
         corner != corners.end() && corner->point.x() <= high + kSame; ++corner) {
      if ((nearest_point(segment, corner->point) - corner->point).norm() > kSame)
        continue;
      for (const Vec2& end : {segment.from, segment.to}) {
        const double length = (end - corner->point).norm();
        if (length <= kSame)
          continue;
        add_arm(*corner, end);
        corner->shortest = corner->shortest == 0.0 ? length : std::min(corner->shortest, length);
      }
    }
  }
  for (Corner& corner : corners)
    tidy(corner.arms);
  std::erase_if(corners, [](const Corner& c) {
    return c.arms.empty() || (c.arms.size() == 2 && is_flat(c.arms[1] - c.arms[0]));
  });
  return corners;
}

CornerShape shape_from(const Corner& corner, const Vec2& viewer) {
  const Vec2 away = viewer - corner.point;
  const double at = norm_angle(std::atan2(away.y(), away.x()));
  // The sector between the two arms around the viewer.
  const auto next = std::ranges::upper_bound(corner.arms, at);
  const bool wraps = next == corner.arms.begin() || next == corner.arms.end();
  const double sector =
      wraps ? corner.arms.front() + 2.0 * kPi - corner.arms.back() : *next - *std::prev(next);
  if (is_flat(sector))
    return CornerShape::kNone;
  if (sector > kPi)
    return CornerShape::kEdge;
  return std::abs(sector - kPi / 2.0) <= kSquare ? CornerShape::kInner : CornerShape::kNone;
}

}  // namespace saphira::sim
