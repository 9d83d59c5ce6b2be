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

}  // namespace saphira::registration
