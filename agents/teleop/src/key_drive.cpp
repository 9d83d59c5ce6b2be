#include "saphira/teleop/key_drive.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>
#include <utility>

namespace saphira::teleop {

namespace {

using Keys = std::vector<std::pair<std::string_view, DriveKey>>;

/// The key that has this character among its own.
std::optional<DriveKey> key_of(char c, const Keys& keys) {
  for (const auto& [characters, key] : keys)
    if (characters.find(c) != std::string_view::npos)
      return key;
  return std::nullopt;
}

std::optional<DriveKey> plain_key(char c) {
  static const Keys keys{{"i", DriveKey::faster},    {"m", DriveKey::slower},
                         {"j", DriveKey::left},      {"l", DriveKey::right},
                         {"k ", DriveKey::stop},     {".\r\n", DriveKey::keep},
                         {"g", DriveKey::constant},  {"c", DriveKey::avoidance},
                         {"h", DriveKey::hand_back}, {"q\x03\x04", DriveKey::quit}};
  return key_of(static_cast<char>(std::tolower(static_cast<unsigned char>(c))), keys);
}

std::optional<DriveKey> arrow(char c) {
  static const Keys keys{{"A", DriveKey::faster},
                         {"B", DriveKey::slower},
                         {"D", DriveKey::left},
                         {"C", DriveKey::right}};
  return key_of(c, keys);
}

}  // namespace

std::vector<DriveKey> take_keys(std::string& input) {
  std::vector<DriveKey> keys;
  std::size_t at = 0;
  while (at < input.size()) {
    if (input[at] != '\x1b') {
      if (const auto key = plain_key(input[at]))
        keys.push_back(*key);
      ++at;
      continue;
    }
    // Cursor keys: ESC [ A, or ESC O A in application mode. Other sequences end with a letter or ~.
    if (at + 1 == input.size())
      break;
    if (input[at + 1] != '[' && input[at + 1] != 'O') {
      ++at;
      continue;
    }
    std::size_t end = at + 2;
    while (end < input.size() && input[end] >= '0' && input[end] <= '?')
      ++end;
    if (end == input.size())
      break;
    if (end == at + 2) {
      if (const auto key = arrow(input[end]))
        keys.push_back(*key);
    }
    at = end + 1;
  }
  input.erase(0, at);
  return keys;
}

void KeyDrive::press(DriveKey key, double now) {
  if (key == DriveKey::stop)
    return release();
  // To go on with nothing would take the robot from whoever drives it.
  if (key > DriveKey::keep || (key == DriveKey::keep && !order(now).active))
    return;
  if (!order(now).active)
    ++order_.turn->move;  // hold the present heading
  const double gap = now - last_key_;
  last_key_ = now;
  // Simultaneous keys count as one: a slow line bundles them.
  if (gap > settings_.burst)
    slowest_ = gap > settings_.first_hold ? 0.0 : std::max(gap, settings_.forget * slowest_);
  if (slowest_ == 0.0)
    hold_until_ = now + settings_.first_hold;
  else
    hold_until_ =
        now + std::clamp(settings_.margin * slowest_, settings_.repeat_hold, settings_.first_hold);
  order_.active = true;

  const double step =
      std::min(settings_.velocity_step, settings_.velocity_rate * (now - last_step_));
  const auto accelerate = [&](double by) {
    last_step_ = now;
    order_.velocity =
        std::clamp(order_.velocity + by, -settings_.max_velocity, settings_.max_velocity);
    if (std::fabs(order_.velocity) < 1e-9)
      order_.velocity = 0.0;
  };
  const auto turn = [&](double by) {
    order_.turn->by = by;
    ++order_.turn->move;
  };
  switch (key) {
    case DriveKey::faster:
      accelerate(step);
      break;
    case DriveKey::slower:
      accelerate(-step);
      break;
    case DriveKey::left:
      turn(settings_.turn_step);
      break;
    case DriveKey::right:
      turn(-settings_.turn_step);
      break;
    default:
      break;
  }
}

void KeyDrive::release() {
  hold_until_ = -1e9;
  last_key_ = -1e9;
  slowest_ = 0.0;
  order_.active = false;
  order_.velocity = 0.0;
  order_.turn->by = 0.0;
}

Order KeyDrive::order(double now) {
  if (order_.active && now > hold_until_)
    release();
  return order_;
}

}  // namespace saphira::teleop
