#include "saphira/registration/range_model.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::registration {

RangeModel::RangeModel(const Field& field, RangeModelSettings settings)
    : field_(&field),
      settings_(settings),
      facing_(std::cos(settings.facing)),
      off_axis_(Pose{0.0, 0.0, settings.cone * 0.7}.direction()),
      log_silent_(std::log(settings.silent)),
      log_slanted_silent_(std::log(settings.slanted_silent)),
      log_far_(std::log(settings.far)) {}

double RangeModel::arc_distance(const Vec2& from, const Vec2& ahead, double range) const {
  const Vec2 along = range * off_axis_.x() * ahead;
  const Vec2 across = range * off_axis_.y() * Vec2(-ahead.y(), ahead.x());
  return std::min({field_->distance(from + range * ahead), field_->distance(from + along - across),
                   field_->distance(from + along + across)});
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

double RangeModel::log_likelihood(const Vec2& sensor, const Vec2& ahead, double range,
                                  bool echo) const {
  const Field::Nearest nearest = field_->nearest(sensor);
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
  if (blocked(sensor, ahead, nearest.distance, range))
    return log_far_;
  const double off = arc_distance(sensor, ahead, range) / settings_.slanted_sigma;
  return std::log(settings_.slanted_heard * std::exp(-0.5 * off * off) + settings_.slanted_other);
}

}  // namespace saphira::registration
