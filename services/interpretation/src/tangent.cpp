#include "saphira/interpretation/tangent.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::interpretation {

std::optional<Line> tangent(const Return& a, const Return& b) {
  const Vec2 way = b.sonar - a.sonar;
  const double apart = way.norm();
  if (apart <= 0.0)
    return std::nullopt;
  // normal * a + range_a = normal * b + range_b
  const double c = (a.range - b.range) / apart;
  if (std::abs(c) >= 1.0)
    return std::nullopt;
  const double s = std::sqrt(1.0 - c * c);
  const Vec2 ahead = way / apart;
  const Vec2 aside(-ahead.y(), ahead.x());
  const Vec2 left = c * ahead + s * aside;
  const Vec2 right = c * ahead - s * aside;
  const Vec2 axis = a.axis + b.axis;
  const Vec2 normal = left.dot(axis) > right.dot(axis) ? left : right;
  return Line{normal, normal.dot(a.sonar) + a.range};
}

LineFit fit_line(const std::vector<const Return*>& echoes, const Line& near, double noise) {
  LineFit fit;
  fit.line = near;
  if (echoes.empty())
    return fit;
  const double n = static_cast<double>(echoes.size());
  Vec2 middle(0.0, 0.0);
  for (const Return* echo : echoes)
    middle += echo->sonar;
  middle /= n;
  double angle = std::atan2(near.normal.y(), near.normal.x());
  double offset = 0.0;  // from the middle
  double spread = 0.0;
  for (int round = 0; round < 3; ++round) {
    const Vec2 normal(std::cos(angle), std::sin(angle));
    const Vec2 along(-normal.y(), normal.x());
    offset = 0.0;
    for (const Return* echo : echoes)
      offset += normal.dot(echo->sonar - middle) + echo->range;
    offset /= n;
    double mixed = 0.0;
    spread = 0.0;
    for (const Return* echo : echoes) {
      const double u = along.dot(echo->sonar - middle);
      mixed += u * (normal.dot(echo->sonar - middle) + echo->range - offset);
      spread += u * u;
    }
    if (spread <= 0.0)
      break;
    angle -= mixed / spread;
  }
  const Vec2 normal(std::cos(angle), std::sin(angle));
  double squares = 0.0;
  offset = 0.0;
  for (const Return* echo : echoes)
    offset += normal.dot(echo->sonar - middle) + echo->range;
  offset /= n;
  for (const Return* echo : echoes) {
    const double off = normal.dot(echo->sonar - middle) + echo->range - offset;
    squares += off * off;
  }
  fit.line = {normal, offset + normal.dot(middle)};
  fit.u_mean = fit.line.u(middle);
  fit.rms = std::sqrt(squares / n);
  const double deviation = std::max(noise, std::sqrt(squares / std::max(1.0, n - 2.0)));
  fit.sigma_offset = deviation / std::sqrt(n);
  fit.sigma_heading = spread > 0.0 ? deviation / std::sqrt(spread) : kPi;
  return fit;
}

}  // namespace saphira::interpretation
