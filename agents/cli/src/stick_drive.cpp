#include "saphira/cli/stick_drive.hpp"

#include <linux/joystick.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace saphira::cli {

namespace {

constexpr unsigned kFirstShoulder = 4;
constexpr unsigned kLastShoulder = 7;
constexpr double kAllTheWay = 32767.0;

}  // namespace

void StickDrive::take(std::string_view bytes, double now) {
  rest_ += bytes;
  std::size_t at = 0;
  for (; rest_.size() - at >= sizeof(js_event); at += sizeof(js_event)) {
    js_event event{};
    std::memcpy(&event, rest_.data() + at, sizeof event);
    const bool first = (event.type & JS_EVENT_INIT) != 0;
    const unsigned type = event.type & ~static_cast<unsigned>(JS_EVENT_INIT);
    const double value = std::clamp(event.value / kAllTheWay, -1.0, 1.0);
    if (type == JS_EVENT_AXIS && event.number == 0)
      left_ = -value;
    else if (type == JS_EVENT_AXIS && event.number == 1)
      ahead_ = -value;
    else if (type == JS_EVENT_BUTTON && !first && event.number >= kFirstShoulder &&
             event.number <= kLastShoulder)
      held_ = event.value != 0 ? held_ | 1U << event.number : held_ & ~(1U << event.number);
    heard_ = now;
  }
  rest_.erase(0, at);
}

void StickDrive::lost() {
  held_ = 0;
  ahead_ = left_ = 0.0;
  rest_.clear();
}

bool StickDrive::is_silent(double now) const {
  return held_ != 0 && now - heard_ > settings_.silence;
}

/// Fine near the middle, full at the end.
double StickDrive::share(double axis) const {
  const double way =
      std::max(0.0, (std::abs(axis) - settings_.dead_zone) / (1.0 - settings_.dead_zone));
  return std::copysign(way * way, axis);
}

StickDrive::Setpoint StickDrive::setpoint(double now) const {
  if (held_ == 0 || is_silent(now))
    return {};
  return {true, settings_.max_velocity * share(ahead_), settings_.max_turn * share(left_)};
}

}  // namespace saphira::cli
