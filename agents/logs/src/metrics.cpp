#include "saphira/logs/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace saphira::logs {

namespace {

Pose between(const Pose& a, const Pose& b, double share) {
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y),
          norm2_angle(a.th + share * norm2_angle(b.th - a.th))};
}

double distance(const Pose& a, const Pose& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty())
    return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Trajectory::Trajectory(std::vector<StampedPose> poses) : poses_(std::move(poses)) {
  std::stable_sort(poses_.begin(), poses_.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.time < b.time; });
}

std::optional<Pose> Trajectory::at(double time) const {
  const auto after = std::lower_bound(poses_.begin(), poses_.end(), time,
                                      [](const StampedPose& p, double t) { return p.time < t; });
  constexpr double kSame = 1e-4;  // stamps are written to a microsecond
  if (after != poses_.end() && after->time - time < kSame)
    return after->pose;
  if (after == poses_.begin())
    return std::nullopt;
  const auto before = after - 1;
  if (time - before->time < kSame)
    return before->pose;
  if (after == poses_.end())
    return std::nullopt;
  return between(before->pose, after->pose, (time - before->time) / (after->time - before->time));
}

double Trajectory::length() const {
  double sum = 0.0;
  for (std::size_t i = 1; i < poses_.size(); ++i)
    sum += distance(poses_[i - 1].pose, poses_[i].pose);
  return sum;
}

Pairs pair_up(const Trajectory& estimate, const Trajectory& reference) {
  Pairs pairs;
  for (const StampedPose& record : reference.poses())
    if (const auto pose = estimate.at(record.time)) {
      pairs.estimate.push_back(*pose);
      pairs.reference.push_back(record.pose);
    }
  return pairs;
}

Pose alignment(const Pairs& pairs) {
  if (pairs.estimate.empty())
    return {};
  Vec2 from = Vec2::Zero();
  Vec2 to = Vec2::Zero();
  const auto n = static_cast<double>(pairs.estimate.size());
  for (std::size_t i = 0; i < pairs.estimate.size(); ++i) {
    from += pairs.estimate[i].position() / n;
    to += pairs.reference[i].position() / n;
  }
  double dot = 0.0;
  double cross = 0.0;
  for (std::size_t i = 0; i < pairs.estimate.size(); ++i) {
    const Vec2 a = pairs.estimate[i].position() - from;
    const Vec2 b = pairs.reference[i].position() - to;
    dot += a.dot(b);
    cross += a.x() * b.y() - a.y() * b.x();
  }
  const Pose turn{0.0, 0.0, std::atan2(cross, dot)};
  const Vec2 at = to - transform(turn, from);
  return {at.x(), at.y(), turn.th};
}

double ate_rmse(const Pairs& pairs) {
  const Pose align = alignment(pairs);
  double squares = 0.0;
  for (std::size_t i = 0; i < pairs.estimate.size(); ++i)
    squares += (transform(align, pairs.estimate[i].position()) - pairs.reference[i].position())
                   .squaredNorm();
  return pairs.estimate.empty() ? 0.0
                                : std::sqrt(squares / static_cast<double>(pairs.estimate.size()));
}

DriftErrors drift(const Pairs& pairs, double length) {
  std::vector<double> translations;
  std::vector<double> rotations;
  std::size_t to = 0;
  double way = 0.0;
  for (std::size_t from = 0; from < pairs.reference.size(); ++from) {
    if (to < from) {
      to = from;
      way = 0.0;
    }
    while (way < length && to + 1 < pairs.reference.size()) {
      way += distance(pairs.reference[to], pairs.reference[to + 1]);
      ++to;
    }
    if (way < length)
      break;
    const Pose off = relative(relative(pairs.reference[from], pairs.reference[to]),
                              relative(pairs.estimate[from], pairs.estimate[to]));
    translations.push_back(std::hypot(off.x, off.y));
    rotations.push_back(std::abs(off.th));
    if (from + 1 < pairs.reference.size())
      way -= distance(pairs.reference[from], pairs.reference[from + 1]);
  }
  return {median(std::move(translations)), median(std::move(rotations))};
}

}  // namespace saphira::logs
