#include "saphira/logs/metrics.hpp"

#include <algorithm>
#include <cmath>

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

Trajectory::Trajectory(std::vector<StampedPose> poses) : poses_(std::move(poses)) {
  std::stable_sort(poses_.begin(), poses_.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.time < b.time; });
}

std::optional<Pose> Trajectory::at(double time, double gap) const {
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
  if (after == poses_.end() || after->time - before->time > gap)
    return std::nullopt;
  return between(before->pose, after->pose, (time - before->time) / (after->time - before->time));
}

double Trajectory::length() const {
  double sum = 0.0;
  for (std::size_t i = 1; i < poses_.size(); ++i)
    sum += distance(poses_[i - 1].pose, poses_[i].pose);
  return sum;
}

Trajectory densify(const Trajectory& scans, const Trajectory& odometry) {
  std::vector<StampedPose> out = scans.poses();
  const auto& at_scans = scans.poses();
  std::size_t next = 0;
  for (const StampedPose& record : odometry.poses()) {
    while (next < at_scans.size() && at_scans[next].time <= record.time)
      ++next;
    if (next == 0 || next == at_scans.size())
      continue;
    const StampedPose& before = at_scans[next - 1];
    const StampedPose& after = at_scans[next];
    const auto odom_before = odometry.at(before.time);
    const auto odom_after = odometry.at(after.time);
    if (!odom_before || !odom_after || record.time - before.time < 1e-4)
      continue;
    // In the frame of the scan before, where turns have a short lever.
    const Pose gone = relative(*odom_before, *odom_after);
    const Pose here = relative(*odom_before, record.pose);
    const Pose off = compose(relative(before.pose, after.pose), relative(gone, Pose{}));
    const double share = (record.time - before.time) / (after.time - before.time);
    const Pose bent = compose(before.pose, compose(between({}, off, share), here));
    out.push_back({record.time, bent});
  }
  return Trajectory(std::move(out));
}

OdometryErrors fit_odometry(const std::vector<Pose>& odometry, const std::vector<Pose>& truth) {
  // Turns: true = scale * measured + per_metre * way; ways: true = scale * measured.
  double tt = 0.0;
  double tw = 0.0;
  double ww = 0.0;
  double to_turn = 0.0;
  double to_way = 0.0;
  double measured_way = 0.0;
  double true_way = 0.0;
  double turn = 0.0;
  double true_turn = 0.0;
  double way = 0.0;
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    turn += norm2_angle(odometry[i].th - odometry[i - 1].th);
    true_turn += norm2_angle(truth[i].th - truth[i - 1].th);
    way += distance(odometry[i], odometry[i - 1]);
    measured_way += distance(odometry[i], odometry[i - 1]);
    true_way += distance(truth[i], truth[i - 1]);
    if (way < 1.0 && std::abs(turn) < 0.5)
      continue;
    tt += turn * turn;
    tw += turn * way;
    ww += way * way;
    to_turn += true_turn * turn;
    to_way += true_turn * way;
    turn = true_turn = way = 0.0;
  }
  OdometryErrors out;
  const double det = tt * ww - tw * tw;
  if (det > 1e-9) {
    out.turn_scale = (to_turn * ww - to_way * tw) / det;
    out.turn_per_metre = (to_way * tt - to_turn * tw) / det;
  }
  if (measured_way > 1.0)
    out.way_scale = true_way / measured_way;
  return out;
}

std::vector<Pose> calibrated(const std::vector<Pose>& odometry, const OdometryErrors& errors) {
  std::vector<Pose> out;
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    if (i == 0) {
      out.push_back(odometry.front());
      continue;
    }
    const Pose step = relative(odometry[i - 1], odometry[i]);
    const double turn =
        errors.turn_scale * step.th + errors.turn_per_metre * std::hypot(step.x, step.y);
    out.push_back(
        compose(out.back(), {errors.way_scale * step.x, errors.way_scale * step.y, turn}));
  }
  return out;
}

Spread spread_of(const std::vector<double>& values) {
  Spread out;
  out.count = values.size();
  if (values.empty())
    return out;
  const auto n = static_cast<double>(values.size());
  for (const double v : values) {
    out.mean += v / n;
    out.squared += v * v / n;
    out.most = std::max(out.most, v);
  }
  out.deviation = std::sqrt(std::max(0.0, out.squared - out.mean * out.mean));
  std::vector<double> sorted = values;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  out.median = *middle;
  return out;
}

RelationErrors relation_errors(const Trajectory& estimate, const std::vector<Relation>& relations) {
  RelationErrors out;
  std::vector<double> translations;
  std::vector<double> rotations;
  for (const Relation& relation : relations) {
    const auto from = estimate.at(relation.from);
    const auto to = estimate.at(relation.to);
    if (!from || !to) {
      ++out.missing;
      continue;
    }
    const Pose off = relative(relation.to_in_from, relative(*from, *to));
    translations.push_back(std::hypot(off.x, off.y));
    rotations.push_back(std::abs(off.th));
  }
  out.translation = spread_of(translations);
  out.rotation = spread_of(rotations);
  return out;
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
  return {spread_of(translations), spread_of(rotations)};
}

}  // namespace saphira::logs
