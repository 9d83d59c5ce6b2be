#include <cmath>
#include <utility>

#include "saphira/base/numbers.hpp"
#include "saphira/intentions/executor.hpp"
#include "saphira/maps/topology.hpp"

// Goals as they come: new ones, changed ones, and those that are refused.
namespace saphira::intentions {
namespace {

/// A point that is fixed in odom when the goal is accepted. A point on the map stays there.
bool to_be_placed(const Argument& argument) {
  return argument.kind == ArgumentKind::point && argument.frame != Frame::map;
}

}  // namespace

void Executor::take_in(const GoalEvent& event) {
  if (event.kind == GoalEvent::Kind::kWritten) {
    take_written(event);
    return;
  }
  const auto found = entries_.find(event.goal.id);
  if (found == entries_.end() || !found->second.open())
    return;
  Entry& entry = found->second;
  if (event.kind == GoalEvent::Kind::kDisposed) {
    end(entry, v1::GOAL_CANCELED, v1::CODE_DISPOSED,
        (event.by.empty() && !event.why.empty()
             ? std::string("withdrawn")
             : "withdrawn by " + (event.by.empty() ? "its requester" : event.by)) +
            (event.why.empty() ? "" : ": " + event.why));
  } else {
    entry.requester.cut_off(awake_);
  }
}

void Executor::take_written(const GoalEvent& event) {
  const Goal& goal = event.goal;
  if (const auto found = entries_.find(goal.id); found != entries_.end()) {
    Entry& entry = found->second;
    if (!entry.open())
      return;  // an ended goal stays ended: its id is not used again
    entry.requester.hear();
    if (goal != entry.goal)
      change(entry, event);
    else
      entry.refusal.clear();  // taken back
    return;
  }
  Entry& entry = entries_[goal.id];
  entry.goal = goal;
  entry.accepted = now_;
  entry.order = next_order_++;
  entry.status.id = goal.id;
  entry.status.requester = goal.requester;
  entry.status.functor = goal.functor;

  if (const Ending* const done = endings_.find(goal.id)) {
    become(entry, done->state, done->code, done->reason);
    entry.status.progress = done->state == v1::GOAL_SUCCEEDED ? 1.0 : 0.0;
    entry.ended = now_;
    ended_order_.push_back(goal.id);
    return;
  }
  GoalCode code = v1::CODE_FORGOTTEN;
  Arguments complete;
  std::string wrong = event.forgotten;
  if (wrong.empty())
    wrong = complaint(event, code, complete);
  if (wrong.empty()) {
    std::size_t all = 0;
    std::size_t own = 0;
    for (const auto& [id, each] : entries_) {
      all += each.open() ? 1 : 0;
      own += each.open() && id.writer == goal.id.writer ? 1 : 0;
    }
    if (all > options_.max_open || own > options_.max_open_of_one) {
      code = v1::CODE_TOO_MANY;
      wrong = "too many goals: " +
              (own > options_.max_open_of_one
                   ? std::to_string(options_.max_open_of_one) + " of this program"
                   : std::to_string(options_.max_open)) +
              " are open already";
    }
  }
  if (!wrong.empty()) {
    end(entry, v1::GOAL_REFUSED, code, std::move(wrong));
    return;
  }
  put_up(entry, goal, std::move(complete));
  // A stop is anybody's at once.
  entry.unapproved = event.needs_approval && !entry.schema->replaces;
  if (!robot_here_)
    become(entry, v1::GOAL_WAITING, v1::CODE_NO_ROBOT, "accepted; waits for the robot");
  else
    become(entry, v1::GOAL_WAITING, v1::CODE_NONE, "accepted");
}

/// Makes the entry one for this goal with checked arguments.
void Executor::put_up(Entry& entry, const Goal& goal, Arguments complete) {
  entry.goal = goal;
  entry.schema = registry_->share(goal.functor);
  entry.arguments = std::move(complete);
  entry.placed = false;
  entry.odom.reset();
  // Places in odom are in the frame that their writer knew.
  if (odom_ && depends_on_odom(entry))
    entry.odom = odom_;
  entry.status.requester = goal.requester;
  entry.status.functor = goal.functor;
}

/// True where another odom frame would change the meaning of the arguments.
bool Executor::depends_on_odom(const Entry& entry) {
  return std::any_of(entry.arguments.begin(), entry.arguments.end(), [&](const Argument& argument) {
    if (argument.kind == ArgumentKind::point)
      return argument.frame == Frame::odom;
    const auto& known = entry.schema->parameters;
    return std::any_of(known.begin(), known.end(), [&](const Parameter& parameter) {
      return parameter.in_odom && parameter.name == argument.name;
    });
  });
}

void Executor::change(Entry& entry, const GoalEvent& event) {
  const Goal& goal = event.goal;
  GoalCode code = v1::CODE_NONE;
  Arguments complete;
  const std::string wrong = complaint(event, code, complete);
  if (!wrong.empty()) {
    // A faulty change leaves the goal as it was.
    entry.status.code = code;
    entry.refusal = wrong;
    entry.refusal_code = code;
    if (entry.status.state == v1::GOAL_UNDERWAY)
      entry.status.reason.clear();
    return;
  }
  entry.refusal.clear();
  const bool other = goal.functor != entry.goal.functor;
  const bool arguments = other || goal.arguments != entry.goal.arguments;
  if (other && entry.node != 0) {
    forest_.remove(std::exchange(entry.node, 0));
    entry.replaced = false;
  }
  if (arguments) {
    put_up(entry, goal, std::move(complete));
    entry.changed = entry.node != 0;
    entry.unapproved = event.needs_approval && !entry.schema->replaces;
    if (other && entry.schema->replaces) {  // it stops what was accepted until now
      entry.accepted = now_;
      entry.order = next_order_++;
    }
  } else {
    entry.goal = goal;
    entry.status.requester = goal.requester;
  }
  entry.status.code = v1::CODE_CHANGED;
  entry.status.waits_for = {};
  entry.status.reason = "changed by " + (event.by.empty() ? "its requester" : event.by);
}

/// A number alone is nobody's name for a place.
bool Executor::is_place(const std::string& functor) const {
  return places_ && registry_->find("go-to-place") != nullptr && !number_in<double>(functor) &&
         places_->place(functor);
}

std::string Executor::complaint(const GoalEvent& event, GoalCode& code, Arguments& complete) const {
  const Goal& goal = event.goal;
  const Schema* const schema = registry_->find(goal.functor);
  if (schema == nullptr) {
    code = v1::CODE_UNKNOWN_FUNCTOR;
    return "there is no activity " + quoted(goal.functor) +
           (is_place(goal.functor)
                ? ", but a place of that name: did you mean go " + goal.functor + "?"
                : ": " + registry_->instead_of(goal.functor));
  }
  code = v1::CODE_BAD_ARGUMENT;
  if (goal.id == GoalId{})
    return "expected an id that is unique for ever, got 0:0";
  if (!(goal.deadline >= 0.0) || !std::isfinite(goal.deadline))
    return "expected a deadline of 0 (none) or more seconds, got " + plain(goal.deadline);
  if (!(goal.level >= 0.0 && goal.level <= 1.0))
    return "expected a level from 0 (the usual one) to 1, got " + plain(goal.level);
  std::string wrong = check_arguments(*schema, goal.arguments, complete);
  if (!wrong.empty())
    return wrong;
  code = v1::CODE_NO_ROUTE;
  for (const Parameter& parameter : schema->parameters)
    if (const Argument* const place = find(complete, parameter.name);
        parameter.place && places_ && place != nullptr && place->kind == ArgumentKind::text &&
        !place->text.empty() && !places_->place(place->text))
      return places_->no_place(place->text);
  code = event.forbidden.empty() ? v1::CODE_NONE : v1::CODE_NO_ROUTE;
  return event.forbidden;
}

/// Fixes the arguments in odom, from the robot's place.
void Executor::place(Entry& entry, const Robot& robot) {
  entry.placed = true;
  for (Argument& argument : entry.arguments) {
    if (!to_be_placed(argument))
      continue;
    if (argument.frame == Frame::robot)
      argument.point = compose(robot.pose_in_odom, argument.point);
    argument.frame = Frame::odom;
  }
  if (depends_on_odom(entry))
    entry.odom = robot.odom;
}

/// Passes changed arguments to the running activities.
void Executor::pass_changes() {
  for (auto& [id, entry] : entries_) {
    if (!entry.changed || !entry.placed)
      continue;
    entry.changed = false;
    if (entry.node == 0 || forest_.activity(entry.node).change(entry.arguments))
      continue;
    forest_.remove(std::exchange(entry.node, 0));
  }
}

}  // namespace saphira::intentions
