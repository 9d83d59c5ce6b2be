#include "free_path.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::behaviors {

double free_path(const std::vector<Vec2>& points, double direction, double radius, double limit) {
  const ToFrame along_way({0.0, 0.0, direction});
  double free = limit;
  for (const Vec2& point : points) {
    const Vec2 p = along_way(point);
    if (p.x() > 0.0 && std::abs(p.y()) < radius)
      free = std::min(free, p.x() - std::sqrt(radius * radius - p.y() * p.y()));
  }
  return std::max(free, 0.0);
}

double clearance(const std::vector<Vec2>& points, double direction, double reach, double most) {
  const ToFrame along_way({0.0, 0.0, direction});
  double away = most;
  for (const Vec2& point : points) {
    const Vec2 p = along_way(point);
    if (p.x() > 0.0 && p.x() < reach)
      away = std::min(away, std::abs(p.y()));
  }
  return away;
}

}  // namespace saphira::behaviors
