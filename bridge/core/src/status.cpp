// The status of the service.

#include "limits.hpp"
#include "saphira/base/format.hpp"
#include "saphira/bridge/core.hpp"

namespace saphira::bridge {

void Core::mind_keeper(double now, const Surroundings& around) {
  if (!around.has_keeper)
    return;
  if (keeper_alive_ && !around.keeper_alive)
    warn("the keeper died or hangs: another one is started");
  keeper_alive_ = around.keeper_alive;
  if (around.keeper_restarts > keeper_restarts_)
    keeper_new_until_ = now + kTellKeeper;
  keeper_restarts_ = around.keeper_restarts;
}

bool Core::motors_off() const {
  const reflector::State& state = reflector_.state();
  const protocol::Information& in = state.information;
  return state.cycle > kMotorsCycles &&
         !in.motors_on.value_or(in.motors != protocol::Motors::kNoPower);
}

/// By the robot's own measure of the charge, or else by the voltage.
bool Core::has_low_battery() const {
  const protocol::Information& in = reflector_.state().information;
  const double low = reflector_.parameters().low_battery;
  if (in.charge_state.value_or(0) != 0)
    return false;
  if (in.state_of_charge)
    return *in.state_of_charge <= kLowCharge;
  return in.battery > kNoSuchBattery * low && in.battery <= kNearlyLow * low;
}

Condition Core::condition(double now, const Surroundings& around) const {
  if (!robot_trouble_.empty())
    return {v1::SERVICE_WAITING, robot_trouble_};
  if (!around.namesake.empty())
    return {in_session() ? v1::SERVICE_DEGRADED : v1::SERVICE_WAITING,
            "another bridge, " + around.namesake + ", has a robot of this name"};
  if (!around.link_open)
    return {v1::SERVICE_WAITING, "robot link: " + around.link_trouble};
  if (!connection_.open())
    return {v1::SERVICE_WAITING, "waits for " + connection_.waiting_for()};
  if (Condition robot = robot_condition(now); robot.health != v1::SERVICE_RUNNING)
    return robot;
  if (around.has_keeper && !around.keeper_alive)
    return {v1::SERVICE_DEGRADED,
            "the keeper is gone: nobody stops the robot when the bridge hangs"};
  if (around.has_keeper && now < keeper_new_until_)
    return {v1::SERVICE_DEGRADED, "the keeper died or hung; another one was started (" +
                                      std::to_string(keeper_restarts_) + " so far)"};
  return {};
}

/// The condition while a robot is connected.
Condition Core::robot_condition(double now) const {
  const std::uint64_t cycle = session_.stamp.cycle;
  const std::string doubt = session_.doubts.newest(now);
  if (session_.silent && !doubt.empty())
    return {v1::SERVICE_WAITING, doubt};
  if (session_.silent && cycle > 0 && line_.bad())
    return {v1::SERVICE_WAITING, "robot link silent: " + line_.words()};
  if (session_.silent)
    return {v1::SERVICE_WAITING, cycle > 0
                                     ? "robot link silent"
                                     : "robot link silent: no packet has come (a simulator in "
                                       "single step needs --lockstep here)"};
  if (settings_.lockstep && !session_.stepping)
    return {v1::SERVICE_WAITING,
            session_.stepped || cycle == 0
                ? "waits for a permit to step"
                : "waits for the behaviors' command for cycle " + std::to_string(cycle)};
  if (arbiter_.latches().estopped)
    return {v1::SERVICE_DEGRADED, "emergency stop, pressed by " + arbiter_.latches().estop_source +
                                      ": saphira estop reset releases it"};
  if (!in_session())
    return {};
  if (!doubt.empty())
    return {v1::SERVICE_DEGRADED, doubt};
  if (now < line_.stands_until())
    return {v1::SERVICE_DEGRADED, line_.why_it_stands(now)};
  if (line_.bad())
    return {v1::SERVICE_DEGRADED, line_.words()};
  if (session_.delay > 0.0)
    return {v1::SERVICE_DEGRADED, delay_words()};
  if (reflector_.state().information.emergency_stop.value_or(false))
    return {v1::SERVICE_DEGRADED, "the robot's own emergency stop is pressed"};
  if (motors_off())
    return {v1::SERVICE_DEGRADED,
            "the robot's motors are off (its own button, or: saphira device motors on)"};
  if (session_.low_battery >= kLowBatteryCycles) {
    const protocol::Information& in = reflector_.state().information;
    return {
        v1::SERVICE_DEGRADED,
        format("the battery is nearly empty (%.1f V%s): bring the robot to its charger", in.battery,
               in.state_of_charge ? format(", %.0f %%", 100.0 * *in.state_of_charge).c_str() : "")};
  }
  return {};
}

/// An obstacle that keeps the bridge from its robot for a while is logged, once.
void Core::tell_wait(const Condition& now_is, double now) {
  const bool waits = now_is.health == v1::SERVICE_WAITING && !settings_.lockstep;
  if (!waits || wait_.reason != now_is.reason)
    wait_ = {waits ? now_is.reason : "", now, false};
  if (!waits || wait_.told || now - wait_.since < kTellWait)
    return;
  wait_.told = true;
  warn("there is no robot yet: " + now_is.reason);
}

void Core::report(double now, const Surroundings& around) {
  if (now - reported_at_ < kCycle)
    return;
  reported_at_ = now;
  if (!in_session() && around.namesake.empty()) {
    // Without a robot there are no cycles; latches are published all the same. Beside a bridge that
    // has the robot, the grant is that bridge's.
    grant_ = arbiter_.decide(time(now), 0);
    publish_grant();
  }
  StatusReport status{
      condition(now, around), session_.stamp, steps_, late_, arbiter_.refused_count(), {}};
  tell_wait(status.condition, now);
  // A step of the bridge is its reaction.
  if (now - reaction_at_ >= 1.0) {
    status.reaction = {reactions_ > 0 ? reaction_sum_ / reactions_ : 0.0, reaction_max_};
    reaction_sum_ = 0.0;
    reaction_max_ = 0.0;
    reactions_ = 0;
    reaction_at_ = now;
  }
  put(std::move(status));
}

}  // namespace saphira::bridge
