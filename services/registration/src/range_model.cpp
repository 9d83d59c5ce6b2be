#include "saphira/registration/range_model.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::registration {

RangeModel::RangeModel(const Field& field, RangeModelSettings settings)
    : field_(&field),
      settings_(settings),
      facing_(std::cos(settings.facing)),
      log_silent_(std::log(settings.silent)),
      log_slanted_silent_(std::log(settings.slanted_silent)),
      log_far_(std::log(settings.far)) {}

double RangeModel::arc_distance(const Pose& sensor, const Vec2& ahead, double range) const {
  const Vec2 at = sensor.position();
  double best = std::min(1e3, field_->distance(at + range * ahead));
  for (const double off : {-1.0, 1.0}) {
    const double bearing = sensor.th + off * settings_.cone * 0.7;
    best =
        std::min(best, field_->distance(at + range * Vec2(std::cos(bearing), std::sin(bearing))));
  }
  return best;
}

/// True where the axis meets a surface before an echo at that range; no surface is nearer than
/// `free`.
bool RangeModel::blocked(const Vec2& from, const Vec2& ahead, double free, double range) const {
  constexpr double kMargin = 0.3;  // [m]
  double at = free;
  for (int step = 0; step < 20 && at < range - kMargin; ++step) {
    free = field_->distance(from + ahead * at);
    if (free < 0.05)
      return true;
    at += free;
  }
  return false;
}

double RangeModel::log_likelihood(const Pose& sensor, double range, bool echo) const {
  const Field::Nearest nearest = field_->nearest(sensor.position());
  const Vec2 ahead = sensor.direction();
  const bool facing =
      nearest.distance < settings_.max_range - 0.3 && nearest.towards.dot(ahead) > facing_;
  if (facing) {
    if (!echo)
      return log_silent_;
    const double off = (range - nearest.distance) / settings_.sigma;
    return std::log(settings_.heard * std::exp(-0.5 * off * off) +
                    (off < 0.0 ? settings_.near : settings_.far));
  }
  if (!echo)
    return log_slanted_silent_;
  if (blocked(sensor.position(), ahead, nearest.distance, range))
    return log_far_;
  const double off = arc_distance(sensor, ahead, range) / settings_.slanted_sigma;
  return std::log(settings_.slanted_heard * std::exp(-0.5 * off * off) + settings_.slanted_other);
}

}  // namespace saphira::registration
