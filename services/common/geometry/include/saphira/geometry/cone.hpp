#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "saphira/geometry/pose.hpp"

namespace saphira {

/// The part of a grid's rows that a sonar's cone can cover. Grids visit only these cells. The spans
/// are not exact: only the cells left out are certainly outside.
class ConeRows {
 public:
  /// From the tip along its heading; `edge` is the tangent of half the opening angle.
  ConeRows(const Pose& tip, double edge, double range)
      : c_(std::cos(tip.th)), s_(std::sin(tip.th)), edge_(edge), range_(range) {}

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
    double high = std::sqrt(left);
    double low = -high;
    // To the right of the left edge, and to the left of the right one.
    for (const double side : {1.0, -1.0}) {
      const double slope = -side * s_ - edge_ * c_;
      const double most = (edge_ * s_ - side * c_) * dy;
      if (slope > kFlat)
        high = std::min(high, most / slope);
      else if (slope < -kFlat)
        low = std::max(low, most / slope);
    }
    return {low, high};
  }

 private:
  static constexpr double kFlat = 1e-9;  // an edge along the row bounds nothing

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
};

}  // namespace saphira
