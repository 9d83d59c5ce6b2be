#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "saphira/geometry/pose.hpp"

namespace saphira {

/// A part of the line from + s * way, between two values of s.
struct Stretch {
  double from = 0.0;
  double to = std::numeric_limits<double>::infinity();
};

/// The part of a stretch that lies in a rectangle around the origin, along the axes, of half the
/// length and width `half`; none: it misses the rectangle.
inline std::optional<Stretch> clip(const Vec2& from, const Vec2& way, const Vec2& half,
                                   Stretch stretch = {}) {
  for (const int axis : {0, 1}) {
    if (std::abs(way[axis]) < 1e-9) {
      if (std::abs(from[axis]) > half[axis])
        return std::nullopt;
      continue;
    }
    const double a = (-half[axis] - from[axis]) / way[axis];
    const double b = (half[axis] - from[axis]) / way[axis];
    stretch.from = std::max(stretch.from, std::min(a, b));
    stretch.to = std::min(stretch.to, std::max(a, b));
  }
  if (stretch.to < stretch.from)
    return std::nullopt;
  return stretch;
}

}  // namespace saphira
