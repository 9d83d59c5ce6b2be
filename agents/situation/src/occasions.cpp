#include "saphira/situation/occasions.hpp"

namespace saphira::situation {

namespace {

constexpr double kApart = 10.0;    // [s] between two of a kind
constexpr double kNoState = 1.0;   // [s] without the robot's state
constexpr double kNotHeard = 3.0;  // [s] without a program's status
constexpr double kHeld = 1.0;      // [s] that the guard holds the robot
constexpr std::size_t kMostFailed = 1024;

}  // namespace

std::optional<Occasion> Occasions::next(const Situation& situation, double now) {
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
  std::optional<Occasion> found;
  const auto note = [&](bool is_new, const char* kind, const std::string& text) {
    if (is_new && !found)
      found = {kind, text};
  };
  const bool begins = !before_;
  const Seen before = before_.value_or(Seen());
  Seen seen = before;
  seen.programs.clear();
  if (const auto& grant = situation.grant) {
    seen.estopped = grant->estopped;
    seen.stop = Key{grant->stop.asker, grant->stop.number};
    note(before.stop && seen.estopped && !before.estopped, "estop",
         "emergency stop by " + grant->estop_source);
    note(before.stop && seen.stop != before.stop, "stopped", "stopped by " + grant->stop_source);
    const bool holds = grant->guard == v1::GUARD_STOP;
    const bool is_long = holds && held_ >= 0.0 && now - held_ >= kHeld;
    note(is_long, "guard", "the guard holds the robot: " + grant->guard_reason);
    // Once, until it lets go.
    held_ = !holds ? -1.0 : is_long ? now + 1e9 : held_ < 0.0 ? now : held_;
  }
  seen.knows_goals = situation.statuses_known;
  // Intentions that begin anew tell the ends of before once more.
  if (seen.failed.size() > kMostFailed)
    seen.failed.clear();
  for (const v1::GoalStatus& status : situation.statuses)
    if (status.state == v1::GOAL_FAILED) {
      const Key id{status.id.writer, status.id.number};
      seen.failed.insert(id);
      note(before.knows_goals && !before.failed.contains(id), "goal-failed",
           status.functor + " has failed: " + status.reason);
    }
  seen.stalled =
      situation.robot && (situation.robot->left_stalled || situation.robot->right_stalled);
  note(seen.stalled && !before.stalled, "stalled", "a wheel of the robot is stalled");
  for (const Program& program : situation.programs) {
    if (program.status.name == "bridge" && program.age < kNotHeard) {
      seen.has_trouble = program.status.state == v1::SERVICE_DEGRADED && !seen.estopped;
      note(!before.programs.empty() && seen.has_trouble && !before.has_trouble, "robot-trouble",
           program.status.reason);
    }
    const std::pair key{program.status.name, program.status.instance};
    if (program.age < kNotHeard)
      seen.programs.insert(key);
    else
      note(before.programs.contains(key), "program-lost",
           program.status.name + " is not heard any more");
  }
  seen.silent = situation.robot && situation.silence >= kNoState;
  note(seen.silent && !before.silent, "silent", "the robot's state does not come any more");
  if (const auto& registration = situation.registration) {
    seen.lost = registration->state == v1::REGISTRATION_LOST;
    note(before.lost && !*before.lost && *seen.lost, "robot-lost",
         "the robot does not know where it is: " + registration->reason);
  }
  before_ = std::move(seen);
  return begins ? std::nullopt : found;
}

}  // namespace saphira::situation
