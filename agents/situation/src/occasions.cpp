#include "saphira/situation/occasions.hpp"

namespace saphira::situation {

namespace {

constexpr double kApart = 10.0;    // [s] between two of a kind
constexpr double kNoState = 1.0;   // [s] without the robot's state
constexpr double kNotHeard = 3.0;  // [s] without a program's status
constexpr double kHeld = 1.0;      // [s] that the guard holds the robot

}  // namespace

std::optional<Occasion> Occasions::look(const Situation& situation, double now) {
  const auto found = find(situation, now);
  if (!found)
    return std::nullopt;
  const auto [told, first] = told_.try_emplace(found->kind, now);
  if (!first && now - told->second < kApart)
    return std::nullopt;
  told->second = now;
  return found;
}

std::optional<Occasion> Occasions::find(const Situation& situation, double now) {
  // Each kind is looked at in each call, so that none is found late.
  std::optional<Occasion> found;
  const auto note = [&](const char* kind, const std::string& text) {
    if (!found && before_)
      found = {kind, text};
  };
  Before present = before_.value_or(Before());
  if (const auto& grant = situation.grant) {
    present.estopped = grant->estopped;
    present.stop = {grant->stop.asker, grant->stop.number};
    if (present.estopped && !(before_ && before_->estopped))
      note("estop", "emergency stop by " + grant->estop_source);
    if (before_ && present.stop != before_->stop && grant->stop.number != 0)
      note("stopped", "stopped by " + grant->stop_source);
    const bool holds = grant->guard == v1::GUARD_STOP;
    if (holds && held_ >= 0.0 && now - held_ >= kHeld) {
      note("guard", "the guard holds the robot: " + grant->guard_reason);
      held_ = now + 1e9;  // once, until it lets go
    }
    held_ = !holds ? -1.0 : held_ < 0.0 ? now : held_;
  }
  for (const v1::GoalStatus& status : situation.statuses) {
    const auto [known, first] =
        goals_.try_emplace({status.id.writer, status.id.number}, status.state);
    if (status.state == v1::GOAL_FAILED && (first || known->second != v1::GOAL_FAILED))
      note("goal-failed", status.functor + " has failed: " + status.reason);
    known->second = status.state;
  }
  for (const Program& program : situation.programs) {
    const std::pair key{program.status.name, program.status.instance};
    if (program.age < kNotHeard)
      programs_.insert(key);
    else if (programs_.erase(key) > 0)
      note("program-lost", program.status.name + " is not heard any more");
  }
  present.silent = situation.robot && situation.silence >= kNoState;
  if (present.silent && !(before_ && before_->silent))
    note("silent", "the robot's state does not come any more");
  if (const auto& registration = situation.registration) {
    present.lost = registration->state == v1::REGISTRATION_LOST;
    if (present.lost && !(before_ && before_->lost))
      note("robot-lost", "the robot does not know where it is: " + registration->reason);
  }
  before_ = present;
  return found;
}

}  // namespace saphira::situation
