#include "saphira/teleop/stick_drive.hpp"

#include <linux/joystick.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <utility>

namespace saphira::teleop {

namespace {

constexpr double kAllTheWay = 32767.0;

template <class Code>
std::set<unsigned> numbers_of(const std::vector<Code>& all, std::initializer_list<int> wanted) {
  std::set<unsigned> numbers;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (std::ranges::find(wanted, all[i]) != wanted.end())
      numbers.insert(static_cast<unsigned>(i));
  return numbers;
}

}  // namespace

void StickDrive::set_layout(const std::vector<std::uint8_t>& axes,
                            const std::vector<std::uint16_t>& buttons) {
  const std::set<unsigned> across = numbers_of(axes, {ABS_X});
  const std::set<unsigned> along = numbers_of(axes, {ABS_Y});
  lost();
  holding_.clear();
  dead_man_.clear();
  if (across.empty() || along.empty())
    return;
  across_ = *across.begin();
  along_ = *along.begin();
  const std::initializer_list<std::pair<const char*, std::initializer_list<int>>> kinds{
      {"a shoulder button", {BTN_TL, BTN_TR, BTN_TL2, BTN_TR2}},
      {"the trigger", {BTN_TRIGGER}},
      {"the dead-man button", {BTN_DEAD}}};
  for (const auto& [name, codes] : kinds) {
    holding_ = numbers_of(buttons, codes);
    if (holding_.empty())
      continue;
    for (const unsigned number : holding_)
      dead_man_ += (dead_man_.empty() ? std::string(name) + " (" : " or ") + std::to_string(number);
    dead_man_ += ')';
    return;
  }
}

void StickDrive::take(std::string_view bytes, double now) {
  rest_ += bytes;
  std::size_t at = 0;
  for (; rest_.size() - at >= sizeof(js_event); at += sizeof(js_event)) {
    js_event event{};
    std::memcpy(&event, rest_.data() + at, sizeof event);
    const bool first = (event.type & JS_EVENT_INIT) != 0;
    const unsigned type = event.type & ~static_cast<unsigned>(JS_EVENT_INIT);
    const double value = std::clamp(event.value / kAllTheWay, -1.0, 1.0);
    if (type == JS_EVENT_AXIS && event.number == across_)
      left_ = -value;
    else if (type == JS_EVENT_AXIS && event.number == along_)
      ahead_ = -value;
    else if (type == JS_EVENT_BUTTON && !first && holding_.contains(event.number)) {
      if (event.value != 0)
        held_.insert(event.number);
      else
        held_.erase(event.number);
    }
    heard_ = now;
  }
  rest_.erase(0, at);
}

void StickDrive::lost() {
  held_.clear();
  ahead_ = left_ = 0.0;
  rest_.clear();
}

bool StickDrive::is_silent(double now) const {
  return !held_.empty() && now - heard_ > settings_.silence;
}

/// Fine near the middle, full at the end.
double StickDrive::share(double axis) const {
  const double way =
      std::max(0.0, (std::abs(axis) - settings_.dead_zone) / (1.0 - settings_.dead_zone));
  return std::copysign(way * way, axis);
}

Order StickDrive::order(double now) const {
  Order order;
  order.active = !held_.empty() && !is_silent(now);
  if (!order.active)
    return order;
  order.velocity = settings_.max_velocity * share(ahead_);
  order.rotation = settings_.max_turn * share(left_);
  return order;
}

}  // namespace saphira::teleop
