#include "saphira/lps/occupancy.hpp"

#include <cmath>

namespace saphira::lps {
namespace {

void take_nearer(Occupancy& best, double distance, const Vec2& point) {
  // Beyond 5 m counts as nothing, as in the manual: 5 m is its value for "nothing".
  if (distance >= kNothing || (best.point && distance >= best.distance))
    return;
  best.distance = distance;
  best.point = point;
}

}  // namespace

Occupancy occupancy_box(const std::vector<Vec2>& points, Axis axis, double cx, double cy, double h,
                        double w) {
  Occupancy best;
  for (const Vec2& p : points)
    if (std::abs(p.x() - cx) <= h / 2.0 && std::abs(p.y() - cy) <= w / 2.0)
      take_nearer(best, std::abs(axis == Axis::front ? p.x() : p.y()), p);
  return best;
}

Occupancy occupancy_plane(const std::vector<Vec2>& points, Direction direction, double d, double s1,
                          double s2) {
  Occupancy best;
  for (const Vec2& p : points) {
    const bool along_x = direction == Direction::front || direction == Direction::back;
    const bool positive = direction == Direction::front || direction == Direction::left;
    const double along = (along_x ? p.x() : p.y()) * (positive ? 1.0 : -1.0);
    const double across = along_x ? p.y() : p.x();
    if (along >= d && across <= s1 && across >= -s2)
      take_nearer(best, along, p);
  }
  return best;
}

}  // namespace saphira::lps
