#include "saphira/teleop/pilot.hpp"

#include <algorithm>

#include "saphira/base/identity.hpp"

namespace saphira::teleop {

std::optional<v1::MotorCommand> Pilot::drive(const Order& order, const v1::Stamp& stamp) {
  if (!order.source.empty())
    source_ = order.source;
  drove_ = drove_ || order.active;
  if (order.active)
    hand_backs_left_ = 0;
  if (!drove_)
    return std::nullopt;
  v1::MotorCommand command;
  // An old state on the person's screen makes the bridge slower, and a too old one is refused. A
  // release and a hand-back are valid with any stamp.
  command.stamp = stamp;
  if (order.active)
    command.stamp.cycle = std::min(order.cycle, stamp.cycle);
  command.source = source_;
  command.number = ++number_;
  command.active = order.active;
  command.hand_back = hand_backs_left_ > 0;
  hand_backs_left_ = std::max(0, hand_backs_left_ - 1);
  command.translation = v1::TRANSLATION_VELOCITY;
  command.velocity = order.velocity;
  command.rotation = v1::ROTATION_VELOCITY;
  command.rotation_velocity = order.rotation;
  if (order.turn) {
    command.rotation = v1::ROTATION_RELATIVE_HEADING;
    command.heading = order.turn->by;
    command.move = order.turn->move;
  }
  return command;
}

void Pilot::hand_back() {
  hand_backs_left_ = kReleases;
  drove_ = true;
}

void Pilot::press(const std::string& person) {
  presser_ = person;
  pressing_ = true;
}

std::optional<v1::MotorCommand> Pilot::stop(bool latched) {
  if (pressing_ && latched) {
    pressing_ = false;
    releases_left_ = kReleases;
  }
  if (!pressing_ && releases_left_ == 0)
    return std::nullopt;
  releases_left_ = std::max(0, releases_left_ - 1);
  return v1::MotorCommand{.source = presser_, .number = ++number_, .active = pressing_};
}

void Pilot::heard(const v1::Grant& grant, double now) {
  for (const v1::Refusal& refusal : grant.refused)
    if (refusal.role == v1::ROLE_TELEOP && is_named(refusal.source, source_)) {
      refusal_ = refusal.reason;
      refused_at_ = now;
    }
}

std::string Pilot::refusal(double now, double within) const {
  return now - refused_at_ < within ? refusal_ : std::string();
}

}  // namespace saphira::teleop
