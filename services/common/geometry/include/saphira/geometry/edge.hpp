#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "saphira/geometry/pose.hpp"

namespace saphira {

/// A part of the building that does not move: a wall, or a door post where both ends are one point.
struct Edge {
  Vec2 from{0.0, 0.0};
  Vec2 to{0.0, 0.0};
  bool operator==(const Edge&) const = default;
};

/// [m] To the nearest point of an edge within a cone round the x axis from the origin; `slope` is
/// the tangent of half its opening angle. None where the edge has no part in the cone.
inline std::optional<double> distance_in_cone(const Edge& edge, double slope) {
  const Vec2 way = edge.to - edge.from;
  double low = 0.0;
  double high = 1.0;
  // The cone is between two lines: slope * x + y >= 0 and slope * x - y >= 0.
  for (const double side : {1.0, -1.0}) {
    const double at_from = slope * edge.from.x() + side * edge.from.y();
    const double rise = slope * way.x() + side * way.y();
    if (at_from < 0.0 && at_from + rise < 0.0)
      return std::nullopt;
    if (at_from < 0.0)
      low = std::max(low, -at_from / rise);
    else if (at_from + rise < 0.0)
      high = std::min(high, -at_from / rise);
  }
  if (low > high)
    return std::nullopt;
  const double length2 = way.squaredNorm();
  const double nearest = length2 > 0.0 ? std::clamp(-edge.from.dot(way) / length2, low, high) : low;
  return (edge.from + nearest * way).norm();
}

}  // namespace saphira
