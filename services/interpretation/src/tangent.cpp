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

LineFit fit_line(const std::vector<const Return*>& echoes, const Line& near,
                 const EchoError& error) {
  LineFit fit;
  fit.line = near;
  if (echoes.empty())
    return fit;
  double newest = 0.0;
  double turned = 0.0;
  for (const Return* echo : echoes) {
    newest = std::max(newest, echo->travelled);
    turned = std::max(turned, echo->turned);
  }
  std::vector<double> weights;
  weights.reserve(echoes.size());
  double all = 0.0;
  double way = 0.0;
  double turn = 0.0;
  Vec2 middle(0.0, 0.0);
  for (const Return* echo : echoes) {
    weights.push_back(1.0 / error.variance(newest - echo->travelled, turned - echo->turned));
    all += weights.back();
    middle += weights.back() * echo->sonar;
  }
  middle /= all;
  double angle = std::atan2(near.normal.y(), near.normal.x());
  double offset = 0.0;  // from the middle
  double spread = 0.0;
  // Three rounds of Gauss and Newton: the angle is known to a few degrees.
  for (int round = 0; round < 3; ++round) {
    const Vec2 normal(std::cos(angle), std::sin(angle));
    const Vec2 along(-normal.y(), normal.x());
    double mixed = 0.0;
    spread = 0.0;
    for (std::size_t i = 0; i < echoes.size(); ++i) {
      const Vec2 from = echoes[i]->sonar - middle;
      const double u = along.dot(from);
      mixed += weights[i] * u * (normal.dot(from) + echoes[i]->range);
      spread += weights[i] * u * u;
    }
    if (spread <= 0.0)
      break;
    angle -= mixed / spread;
  }
  const Vec2 normal(std::cos(angle), std::sin(angle));
  for (std::size_t i = 0; i < echoes.size(); ++i)
    offset += weights[i] * (normal.dot(echoes[i]->sonar - middle) + echoes[i]->range);
  offset /= all;
  fit.line = {normal, offset + normal.dot(middle)};
  fit.u_mean = fit.line.u(middle);
  double squares = 0.0;
  // The heading comes from the echoes by their leverage.
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const double off = normal.dot(echoes[i]->sonar - middle) + echoes[i]->range - offset;
    squares += weights[i] * off * off;
    const double u = fit.line.u(echoes[i]->sonar) - fit.u_mean;
    way += weights[i] * u * u * (newest - echoes[i]->travelled);
    turn += weights[i] * u * u * (turned - echoes[i]->turned);
  }
  const double n = static_cast<double>(echoes.size());
  fit.rms = std::sqrt(squares / all);
  const double scale = std::max(1.0, std::sqrt(squares / std::max(1.0, n - 2.0)));
  fit.sigma_offset = scale / std::sqrt(all);
  // The drift of dead reckoning since then is the same for all of them: it does not average out.
  const double strayed = spread > 0.0 ? error.heading_variance(way / spread, turn / spread) : 0.0;
  fit.sigma_heading = spread > 0.0 ? std::sqrt(scale * scale / spread + strayed) : kPi;
  return fit;
}

}  // namespace saphira::interpretation
