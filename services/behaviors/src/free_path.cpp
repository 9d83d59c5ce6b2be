#include "free_path.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::behaviors {

double free_path(const std::vector<Vec2>& points, double direction, double radius, double limit) {
  const double c = std::cos(direction);
  const double s = std::sin(direction);
  double free = limit;
  for (const Vec2& p : points) {
    const double along = c * p.x() + s * p.y();
    const double across = -s * p.x() + c * p.y();
    if (along <= 0.0 || std::abs(across) >= radius)
      continue;
    free = std::min(free, along - std::sqrt(radius * radius - across * across));
  }
  return std::max(free, 0.0);
}

}  // namespace saphira::behaviors
