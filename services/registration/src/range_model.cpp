#include "saphira/registration/range_model.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::registration {

double RangeModel::arc_distance(const Pose& sensor, double range) const {
  double best = 1e3;
  for (const double off : {0.0, -1.0, 1.0}) {
    const double bearing = sensor.th + off * settings_.cone * 0.7;
    const Vec2 end = sensor.position() + range * Vec2(std::cos(bearing), std::sin(bearing));
    best = std::min(best, field_->distance(end));
  }
  return best;
}

bool RangeModel::blocked(const Pose& sensor, double range, double margin) const {
  const Vec2 ahead = sensor.direction();
  double at = field_->distance(sensor.position());
  for (int step = 0; step < 20 && at < range - margin; ++step) {
    const double free = field_->distance(sensor.position() + ahead * at);
    if (free < 0.05)
      return true;
    at += free;
  }
  return false;
}

double RangeModel::log_likelihood(const Pose& sensor, double range, bool echo) const {
  const Field::Nearest nearest = field_->nearest(sensor.position());
  const bool facing = nearest.distance < settings_.max_range - 0.3 &&
                      nearest.towards.dot(sensor.direction()) > std::cos(settings_.facing);
  if (facing) {
    if (!echo)
      return std::log(settings_.silent);
    const double off = (range - nearest.distance) / settings_.sigma;
    return std::log(settings_.heard * std::exp(-0.5 * off * off) +
                    (off < 0.0 ? settings_.near : settings_.far));
  }
  if (!echo)
    return std::log(settings_.slanted_silent);
  if (blocked(sensor, range, 0.3))
    return std::log(settings_.far);
  const double off = arc_distance(sensor, range) / settings_.slanted_sigma;
  return std::log(settings_.slanted_heard * std::exp(-0.5 * off * off) + settings_.slanted_other);
}

RangeModel::Verdict RangeModel::verdict(const Pose& sensor, double range, bool echo,
                                        double slack) const {
  if (!field_->known(sensor.position()))
    return Verdict::nothing;
  const Field::Nearest nearest = field_->nearest(sensor.position());
  // Only what is well inside the cone for sure counts: the pose's heading may be off, too.
  const double aside = nearest.towards.dot(sensor.direction());
  const double tolerance = 0.15 + slack;
  const bool faces = nearest.distance < 2.5 && aside > std::cos(settings_.facing * 0.7);
  if (!echo)
    return faces && nearest.distance > tolerance ? Verdict::against : Verdict::nothing;
  if (faces && std::abs(range - nearest.distance) < tolerance)
    return Verdict::explained;
  if (!field_->known(sensor.position() + sensor.direction() * (range - 0.1)))
    return blocked(sensor, range, tolerance + 0.15) ? Verdict::against : Verdict::nothing;
  if (arc_distance(sensor, range) < tolerance)
    return Verdict::explained;
  return blocked(sensor, range, tolerance + 0.15) ? Verdict::against : Verdict::foreign;
}

}  // namespace saphira::registration
