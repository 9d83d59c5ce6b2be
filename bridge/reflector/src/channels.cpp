#include "saphira/reflector/channels.hpp"

#include <cmath>

namespace saphira::reflector {

namespace {

constexpr protocol::Number kVel = protocol::Number::kVelocity;
constexpr protocol::Number kHead = protocol::Number::kHeading;
constexpr protocol::Number kRvel = protocol::Number::kRotationVelocity;
constexpr protocol::Number kEstop = protocol::Number::kEmergencyStop;

constexpr double kTick = 1e-6;           // [s] five cycles of 0.1 s are 0.5 s
constexpr double kShownVelocity = 0.02;  // [m/s]
constexpr double kShownHeading = 0.03;   // [rad] a degree, and the server's own rounding
constexpr double kShownRotation = 0.09;  // [rad/s] coarse, since it comes from wheel velocities

constexpr Order kNoMove{kVel, 0};
constexpr Order kNoTurn{kRvel, 0};

bool is_stop(const Order& order) {
  return order == kNoMove || order == kNoTurn;
}

int whole(double value) {
  return static_cast<int>(std::lround(value));
}

}  // namespace

protocol::Command to_command(const Order& order) {
  switch (order.number) {
    case kVel:
      return protocol::Velocity{order.argument * 0.001};
    case kHead:
      return protocol::Heading{radians(order.argument)};
    case kRvel:
      return protocol::RotationVelocity{radians(order.argument)};
    case kEstop:
      return protocol::EmergencyStop{};
    default:
      return protocol::Pulse{};
  }
}

void Channels::connect() {
  channels_[0] = {};
  channels_[1] = {};
  channels_[0].want = kNoMove;
  channels_[1].want = kNoTurn;
  brake_.reset();
}

void Channels::brake(bool on) {
  if (!on) {
    brake_.reset();
  } else if (!brake_) {
    // The brake voids earlier setpoints: when it ends, setpoints are sent anew.
    connect();
    brake_ = Channel{{kEstop, 0}, {}, 0.0, false, false};
  }
}

void Channels::want(const Setpoints& setpoints, double rotation) {
  channels_[0].want = {kVel, whole(setpoints.velocity * 1000.0)};
  if (setpoints.turn_to_heading)
    channels_[1].want = {kHead,
                         whole(degrees(norm_angle(setpoints.heading_in_odom - rotation))) % 360};
  else
    channels_[1].want = {kRvel, whole(degrees(setpoints.rotation_velocity))};
  for (Channel& channel : channels_) {
    if (channel.sent != channel.want)
      channel.shown = false;
  }
}

void Channels::cycle(const Shown& shown) {
  if (brake_) {
    brake_->in_cycle = false;
    brake_->shown = std::abs(shown.velocity) <= kShownVelocity &&
                    std::abs(shown.rotation_velocity) <= kShownRotation;
  }
  for (Channel& channel : channels_) {
    channel.in_cycle = false;
    const Order& want = channel.want;
    if (want.number == kVel)
      channel.shown = std::abs(want.argument * 0.001 - shown.velocity) <= kShownVelocity;
    else if (want.number == kHead)
      channel.shown =
          std::abs(norm2_angle(radians(want.argument) - shown.control)) <= kShownHeading;
    else
      channel.shown = std::abs(radians(want.argument) - shown.rotation_velocity) <= kShownRotation;
  }
}

bool Channels::is_due(const Channel& channel, double now) {
  const bool changed = channel.sent != channel.want;
  // Without packets there are no cycles; the beat goes on.
  if (now - channel.at >= kRepeat - kTick)
    return true;
  if (channel.in_cycle)
    return changed && is_stop(channel.want);
  return changed || !channel.shown;
}

bool Channels::pending(double now) const {
  if (brake_)
    return is_due(*brake_, now);
  return is_due(channels_[0], now) || is_due(channels_[1], now);
}

std::vector<Order> Channels::due(double now) {
  std::vector<Order> out;
  const auto take = [&](Channel& channel) {
    if (!is_due(channel, now))
      return;
    channel.sent = channel.want;
    channel.at = now;
    channel.in_cycle = true;
    out.push_back(channel.want);
  };
  if (brake_) {
    // For a server without the emergency stop.
    if (is_due(*brake_, now))
      out = {kNoMove, kNoTurn};
    take(*brake_);
    return out;
  }
  for (Channel& channel : channels_)
    take(channel);
  return out;
}

double Channels::sent_velocity() const {
  return channels_[0].sent ? channels_[0].sent->argument * 0.001 : 0.0;
}

}  // namespace saphira::reflector
