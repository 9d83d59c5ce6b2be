#include "saphira/teleop/control.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/base/format.hpp"

namespace saphira::teleop {

namespace {

constexpr double kClockDrift = 1e-3;  // more than the drift of two clocks
constexpr const char* kGap = "the picture came too late, so the robot stopped";
constexpr const char* kHeldBefore = "it was held already when control came";

std::string seconds(double value) {
  return format("%.1f s", value);
}

}  // namespace

std::string Control::name_of(OperatorId id) const {
  const auto found = operators_.find(id);
  return found == operators_.end() ? "nobody" : found->second;
}

void Control::drop(const std::string& note) {
  holder_ = 0;
  newest_ = {};
  any_ = false;
  note_ = note;
}

// A sample that ends the silence also comes too late: samples that waited while this program hung
// or the link was cut are no sign of an attentive operator.
void Control::lose_silent(double now) {
  const double silence = now - came_;
  if (holder_ != 0 && silence > settings_.lose)
    drop("nothing was heard of " + name_of(holder_) + " for " + seconds(silence) +
         ": the robot stands, and control is free");
}

void Control::notice_gap(double now) {
  if (now - came_ <= settings_.hold)
    return;
  let_go_ = kGap;
  held_since_ = counted_;
}

void Control::join(OperatorId id, const std::string& name) {
  operators_[id] = name;
}

void Control::leave(OperatorId id) {
  if (holder_ == id)
    drop(name_of(id) + " is gone: nobody has control");
  std::erase(asked_, id);
  operators_.erase(id);
}

std::string Control::take(OperatorId id, bool force, double now) {
  if (!operators_.contains(id))
    return "not known here: give the key first";
  if (holder_ == id)
    return {};
  if (holder_ != 0 && !force)
    return name_of(holder_) + " has control: ask for it, or take it";
  const std::string from = holder_ == 0 ? std::string() : " from " + name_of(holder_);
  hand_to(id, name_of(id) + " took control" + from, now);
  return {};
}

void Control::hand_to(OperatorId id, const std::string& note, double now) {
  drop(note);
  holder_ = id;
  std::erase(asked_, id);
  came_ = now;
  counted_ = held_since_ = 0;
  let_go_ = kHeldBefore;
}

std::string Control::ask(OperatorId id) {
  if (!operators_.contains(id))
    return "not known here: give the key first";
  if (holder_ == 0)
    return "nobody has control: take it";
  if (holder_ == id)
    return "you have control";
  if (std::ranges::find(asked_, id) == asked_.end())
    asked_.push_back(id);
  return {};
}

std::string Control::give(OperatorId id, OperatorId to, double now) {
  if (holder_ != id || holder_ == 0)
    return "you do not have control";
  if (std::ranges::find(asked_, to) == asked_.end())
    return name_of(to) + " does not ask for control any more";
  hand_to(to, name_of(id) + " gave control to " + name_of(to), now);
  return {};
}

void Control::release(OperatorId id) {
  if (holder_ == id)
    drop(name_of(id) + " released control");
  std::erase(asked_, id);
}

std::string Control::drive(OperatorId id, const Sample& sample, double now) {
  lose_silent(now);
  if (holder_ != id || holder_ == 0)
    return "you do not have control";
  if (!std::isfinite(sample.device_time) || !std::isfinite(sample.velocity) ||
      !std::isfinite(sample.rotation))
    return "a number was expected";
  const double difference = now - sample.device_time;
  if (any_) {
    if (sample.number <= newest_.number) {
      if (!sample.active && sample.number > held_since_ && difference - quickest_ <= settings_.late)
        let_go_.clear();
      return kRepeated;
    }
    if (sample.device_time < newest_.device_time)
      return "the device's time went back";
    quickest_ = std::min(difference, quickest_ + kClockDrift * (now - came_));
  } else {
    quickest_ = difference;
  }
  // A sample delayed in the network is refused; its number and time still count.
  const double late = difference - quickest_;
  newest_.number = sample.number;
  newest_.device_time = sample.device_time;
  any_ = true;
  if (late > settings_.late)
    return "came " + seconds(late) + " late";
  notice_gap(now);
  came_ = now;
  counted_ = sample.number;
  newest_ = sample;
  if (!sample.active)
    let_go_.clear();
  return let_go_;
}

Order Control::order(double now) {
  Order order;
  lose_silent(now);
  if (holder_ == 0)
    return order;
  order.source = name_of(holder_);
  notice_gap(now);
  if (!any_ || !let_go_.empty() || !newest_.active)
    return order;
  order.active = true;
  order.velocity = newest_.velocity;
  order.rotation = newest_.rotation;
  order.cycle = newest_.cycle;
  return order;
}

Control::State Control::state() const {
  State state{
      holder_, holder_ == 0 ? "" : name_of(holder_), {}, note_, holder_ == 0 ? "" : let_go_};
  for (const OperatorId id : asked_)
    state.asked.push_back({id, name_of(id)});
  return state;
}

}  // namespace saphira::teleop
