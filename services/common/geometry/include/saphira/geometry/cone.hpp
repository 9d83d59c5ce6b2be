#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "saphira/geometry/pose.hpp"

namespace saphira {

/// The part of a grid's rows that a sonar's cone can cover. Grids visit only these cells. The spans
/// are not exact: only the cells left out are certainly outside.
class ConeRows {
 public:
  /// From the tip along its heading; `edge` is the tangent of half the opening angle.
  ConeRows(const Pose& tip, double edge, double range)
      : c_(std::cos(tip.th)), s_(std::sin(tip.th)), edge_(edge), range_(range) {
    // To the right of the left edge, and to the left of the right one.
    for (const std::size_t i : {0U, 1U}) {
      const double side = i == 0 ? 1.0 : -1.0;
      const double slope = -side * s_ - edge_ * c_;
      const Bound bound{(edge_ * s_ - side * c_) / slope, 0.0};
      if (slope > kFlat)
        highest_[i] = bound;
      else if (slope < -kFlat)
        lowest_[i] = bound;
    }
  }

  /// Cosine and sine of the heading.
  double cosine() const { return c_; }
  double sine() const { return s_; }

  /// The lowest and the highest place that it reaches along y from the tip [m]...
  std::pair<double, double> rows() const { return reach(s_, c_); }
  /// ...and along x.
  std::pair<double, double> columns() const { return reach(c_, s_); }

  /// The span along x from the tip [m], in the row at dy beside it; the second is smaller where the
  /// cone does not reach the row.
  std::pair<double, double> span(double dy) const {
    const double left = range_ * range_ - dy * dy;
    if (left < 0.0)
      return {1.0, -1.0};
    const double half = std::sqrt(left);
    return {std::max(-half, std::max(lowest_[0].at(dy), lowest_[1].at(dy))),
            std::min(half, std::min(highest_[0].at(dy), highest_[1].at(dy)))};
  }

 private:
  static constexpr double kFlat = 1e-9;  // an edge along the row bounds nothing
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  /// The place of an edge in a row, along x from the tip [m].
  struct Bound {
    double at(double dy) const { return slant * dy + offset; }
    double slant = 0.0;
    double offset = 0.0;
  };

  /// On an axis, with the heading's parts along it and across it.
  std::pair<double, double> reach(double along, double across) const {
    const double side = range_ / std::sqrt(1.0 + edge_ * edge_);
    const double left = side * (along + edge_ * across);
    const double right = side * (along - edge_ * across);
    const bool holds_axis = std::abs(across) <= edge_ * std::abs(along);
    return {holds_axis && along < 0.0 ? -range_ : std::min({0.0, left, right}),
            holds_axis && along > 0.0 ? range_ : std::max({0.0, left, right})};
  }

  double c_;
  double s_;
  double edge_;
  double range_;
  std::array<Bound, 2> lowest_{Bound{0.0, -kFar}, Bound{0.0, -kFar}};
  std::array<Bound, 2> highest_{Bound{0.0, kFar}, Bound{0.0, kFar}};
};

}  // namespace saphira
