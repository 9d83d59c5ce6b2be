#include "saphira/intentions/executor.hpp"

#include <tuple>
#include <utility>

#include "saphira/base/numbers.hpp"

namespace saphira::intentions {
namespace {

/// Goals that may begin in one cycle, each after the one before it ended in its first step.
constexpr int kBeginsPerCycle = 8;

/// A step after more cycles than this has slept meanwhile.
constexpr Ticks kLongestStep = 10;

constexpr const char* kPositionLost =
    "position lost: the robot's dead reckoning has begun anew since the goal was accepted, so "
    "where "
    "the goal is cannot be told";

std::string name_of_goal(const Goal& goal) {
  constexpr std::size_t kLongest = 100;  // bytes
  std::string name = goal.functor;
  if (const std::string arguments = describe(goal.arguments); !arguments.empty())
    name += " " + std::string(first_letters(arguments, kLongest)) +
            (arguments.size() > kLongest ? "..." : "");
  if (!goal.requester.empty())
    name += " of " + quoted(goal.requester);
  return name;
}

}  // namespace

Executor::Executor(Registry registry, const Memory& memory, ExecutorOptions options)
    : options_(std::move(options)),
      registry_(std::make_shared<Registry>(std::move(registry))),
      endings_(options_.max_ended) {
  if (!options_.functions)
    options_.functions = std::make_shared<const Functions>(core_functions());
  beliefs_ = std::make_shared<Beliefs>(options_.functions.get());
  forest_ = Forest(registry_, beliefs_, options_.forest);
  for (const Ending& ending : memory.endings)
    endings_.recall(ending);
  if (memory.work.epoch != 0)
    recall(memory.work);
}

GoalUpdates Executor::take_events(const std::vector<GoalEvent>& events) {
  for (const GoalEvent& event : events)
    take_in(event);
  forget_ended();
  return take_updates();
}

Outputs Executor::step(const Inputs& inputs) {
  pass_time(inputs);
  for (const GoalEvent& event : inputs.events)
    take_in(event);
  for (auto& [id, entry] : entries_) {
    if (std::exchange(entry.fresh, false))
      entry.accepted = now_;
    if (entry.open())
      entry.status.elapsed = in_seconds(now_ - entry.accepted);
  }
  robot_here_ = inputs.robot.connected && inputs.hold.empty();
  on_map_ = inputs.robot.odom_in_map.has_value();
  person_ = inputs.person;
  if (robot_here_) {
    meet_odom(inputs.robot.odom);
    for (auto& [id, entry] : entries_) {
      if (entry.open() && !entry.placed)
        place(entry, inputs.robot);
    }
    pass_changes();
  } else {
    lose_robot(inputs.robot.connected ? inputs.hold : std::string());
  }
  settle();
  check_deadlines(inputs.robot);
  replace();
  if (!inputs.estop.empty())
    end_driving("emergency stop, pressed by " + quoted(inputs.estop) +
                ": ask anew once it is released");
  if (inputs.stop && stops_.take(*inputs.stop))
    end_driving("stopped by " + inputs.stop_source + ": ask anew to have it done");
  if (std::ranges::none_of(entries_, [](const auto& each) {
        return each.second.open() && each.second.schema->replaces;
      }))
    stops_.give_up(inputs.confirms_stops);
  for (const ClaimEvent& claim : inputs.claims)
    beliefs_->take(claim, awake_);
  Surroundings around = inputs.around;
  around.stop_confirmed = stops_.confirmed() || !inputs.confirms_stops;
  const World world{inputs.robot, around, *beliefs_, awake_};
  beliefs_->evaluate_conditions(world);
  if (inputs.behaviors_cycle > 0)
    forest_.hear(
        inputs.behaviors,
        awake_ - static_cast<Ticks>(inputs.cycle - inputs.behaviors_cycle + inputs.intent_age));
  forest_.hear(inputs.troubles);
  if (robot_here_)
    arbitrate();
  forest_.step(world);
  // The next goal begins in the cycle in which the one before it ends: a gap in the intent would
  // release the robot.
  for (int begun = 0; collect() && robot_here_ && begun < kBeginsPerCycle; ++begun) {
    if (const Entry* const next = arbitrate())
      forest_.begin(next->node, world);
  }
  forget_ended();
  for (auto& [id, entry] : entries_)
    measure(entry);
  Outputs outputs{forest_.behaviors(),        forest_.nodes(),     {},
                  forest_.behavior_control(), forest_.take_said(), forest_.take_requests(),
                  forest_.take_questions()};
  outputs.updates = take_updates();
  outputs.stop = stops_.asks(now_, inputs.confirms_stops);
  return outputs;
}

void Executor::pass_time(const Inputs& inputs) {
  Ticks passed = 0;
  if (inputs.epoch != epoch_) {
    passed = epoch_ == 0 ? 0 : 1;
    for (auto& [id, entry] : entries_)
      entry.requester.meet_bridge();
  } else if (inputs.cycle > cycle_) {
    passed = static_cast<Ticks>(inputs.cycle - cycle_);
  }
  now_ += passed;
  awake_ += std::min(passed, kLongestStep);
  epoch_ = inputs.epoch;
  cycle_ = inputs.cycle;
}

// --- states

void Executor::become(Entry& entry, GoalState state, GoalCode code, std::string reason) {
  entry.status.state = state;
  entry.status.code = code;
  entry.status.reason = std::move(reason);
  entry.status.waits_for = {};
}

void Executor::end(Entry& entry, GoalState state, GoalCode code, std::string reason) {
  if (entry.node != 0)
    forest_.remove(std::exchange(entry.node, 0));
  entry.ended = now_;
  ended_order_.push_back(entry.goal.id);
  become(entry, state, code, reason.empty() ? word_of(state) : std::move(reason));
  entry.status.step.clear();
  if (state == v1::GOAL_SUCCEEDED)
    entry.status.progress = 1.0;
  endings_.add({entry.goal.id, state, code, entry.status.reason});
}

void Executor::suspend(Entry& entry, GoalCode code, std::string reason) {
  if (entry.status.state == v1::GOAL_UNDERWAY && entry.node != 0)
    forest_.interrupt(entry.node);
  become(entry, v1::GOAL_SUSPENDED, code, std::move(reason));
  entry.status.step.clear();
}

void Executor::lose_robot(const std::string& hold) {
  robot_here_ = false;
  for (auto& [id, entry] : entries_)
    lose_robot(entry, hold);
}

void Executor::lose_robot(Entry& entry, const std::string& hold) {
  const GoalCode code = hold.empty() ? v1::CODE_NO_ROBOT : v1::CODE_NONE;
  if (entry.status.state == v1::GOAL_WAITING)
    become(entry, v1::GOAL_WAITING, code, hold.empty() ? "waits for the robot" : hold);
  else if (entry.open())
    suspend(entry, code, hold.empty() ? "the robot is not heard; goes on when it is" : hold);
}

void Executor::meet_odom(std::uint64_t odom) {
  if (!odom_ || std::exchange(odom_, odom) == odom) {
    odom_ = odom;
    return;
  }
  for (auto& [id, entry] : entries_) {
    if (entry.open() && entry.odom && *entry.odom != odom)
      end(entry, v1::GOAL_FAILED, v1::CODE_NO_ROBOT, kPositionLost);
    // Its memory has places in the earlier odom: it begins anew.
    if (entry.open() && entry.node != 0 && entry.schema->program) {
      forest_.remove(std::exchange(entry.node, 0));
      entry.status.note =
          "was begun anew at its first step: the robot's dead reckoning has begun anew";
    }
  }
  // A text is no place in the earlier frame.
  for (const Belief& belief : lasting_beliefs())
    if (belief.value.text() == nullptr)
      beliefs_->unset(belief.name);
}

/// Goals whose program is not heard.
void Executor::settle() {
  for (auto& [id, entry] : entries_) {
    if (!entry.open())
      continue;
    const v1::WriterLost policy = entry.goal.writer_lost;
    const Requester::Turn turn = entry.requester.pass(policy, awake_);
    if (turn == Requester::Turn::kEnds)
      end(entry, v1::GOAL_CANCELED, v1::CODE_WRITER_LOST, entry.requester.why_ended(policy));
    std::string& told = entry.status.note;
    if (turn == Requester::Turn::kKept)
      told += std::string(told.empty() ? "" : ", and ") +
              "is kept: intentions was restarted, and nobody asks for it any more";
  }
}

void Executor::check_deadlines(const Robot& robot) {
  for (auto& [id, entry] : entries_) {
    if (!entry.open() || entry.goal.deadline <= 0.0)
      continue;
    // Half a tick of slack, for the rounding of the sum.
    if (in_seconds(now_ - entry.accepted) + 0.5 * kTick < entry.goal.deadline)
      continue;
    std::string success;
    if (entry.status.state == v1::GOAL_UNDERWAY && entry.node != 0 &&
        !forest_.held(entry.node, Hold::kPerson))
      success = forest_.activity(entry.node).at_deadline(robot);
    if (!success.empty()) {
      end(entry, v1::GOAL_SUCCEEDED, v1::CODE_NONE, std::move(success));
      continue;
    }
    const GoalStatus& status = entry.status;
    const std::string& doing = status.state == v1::GOAL_UNDERWAY ? status.step : status.reason;
    end(entry, v1::GOAL_FAILED, v1::CODE_DEADLINE,
        "not done within its deadline of " + plain(entry.goal.deadline) + " s; it was " +
            word_of(status.state) + (doing.empty() ? "" : ": " + doing));
  }
}

/// Ends all goals that a stop replaces: every earlier driving goal. A stop is stronger than any
/// priority.
void Executor::replace() {
  for (auto& [id, stop] : entries_) {
    if (!stop.open() || !stop.schema->replaces || stop.replaced)
      continue;
    stop.replaced = true;
    stops_.ask(stop.goal.requester, now_);
    for (auto& [other_id, other] : entries_) {
      const bool earlier =
          std::pair(other.accepted, other.order) < std::pair(stop.accepted, stop.order);
      if (other.open() && other.drives() && earlier) {
        end(other, v1::GOAL_CANCELED, v1::CODE_STOPPED, "stopped by " + name_of_goal(stop.goal));
        other.status.waits_for = id;
      }
    }
  }
}

/// Goals that have been stopped do not go on by themselves.
void Executor::end_driving(const std::string& why) {
  for (auto& [id, entry] : entries_)
    if (entry.open() && entry.drives())
      end(entry, v1::GOAL_CANCELED, v1::CODE_STOPPED, why);
}

bool Executor::approve(const GoalId& id) {
  const auto found = entries_.find(id);
  return found != entries_.end() && found->second.open() &&
         std::exchange(found->second.unapproved, false);
}

/// Why the goal waits: its program is not heard, it is not approved, or it drives while the place
/// of the robot is not known yet, or a person has the robot. Without a text it does not.
Executor::Wait Executor::why_to_wait(const Entry& entry) const {
  // A stop is anybody's at once.
  if (entry.schema->replaces)
    return {};
  if (std::string why = entry.requester.why_to_wait(entry.goal.writer_lost); !why.empty())
    return {std::move(why), v1::CODE_WRITER_LOST};
  if (entry.unapproved)
    return {"waits for a person's approval: saphira goal approve " + describe(entry.goal.id),
            v1::CODE_APPROVAL};
  if (!entry.drives())
    return {};
  // After a restart registration is heard some cycles later.
  if (entry.before && !on_map_ && awake_ < place_by_)
    return {"waits until it is known where the robot is"};
  return {person_};
}

/// Gives the robot to the best goal; returns the goal that is underway now, nullptr: none. Goals of
/// concurrent schemas are underway beside it.
Executor::Entry* Executor::arbitrate() {
  std::vector<Entry*> ready;
  std::vector<Entry*> beside;
  for (auto& [id, entry] : entries_) {
    if (!entry.open())
      continue;
    const Wait wait_for = why_to_wait(entry);
    if (wait_for.why.empty())
      (entry.schema->concurrent ? beside : ready).push_back(&entry);
    else if (entry.status.state == v1::GOAL_WAITING)
      become(entry, v1::GOAL_WAITING, wait_for.code, wait_for.why);
    else
      suspend(entry, wait_for.code == v1::CODE_NONE ? v1::CODE_PREEMPTED : wait_for.code,
              wait_for.why);
  }
  const auto best = std::ranges::min_element(ready, {}, [](const Entry* entry) {
    return std::tuple(-static_cast<std::int64_t>(entry->goal.priority), entry->accepted,
                      entry->order);
  });
  Entry* const chosen = best == ready.end() ? nullptr : *best;
  for (Entry* const entry : ready)
    if (entry != chosen)
      queue(*entry, chosen->goal);
  if (chosen != nullptr)
    begin(*chosen);
  for (Entry* const entry : beside)
    begin(*entry);
  return chosen;
}

/// The goal waits, or is interrupted, because of the one in front of it.
void Executor::queue(Entry& entry, const Goal& front) {
  const bool more = front.priority > entry.goal.priority;
  const std::string who =
      name_of_goal(front) +
      (more ? ", which is more important (priority " + std::to_string(front.priority) + " over " +
                  std::to_string(entry.goal.priority) + ")"
            : ", which came first");
  if (entry.status.state == v1::GOAL_WAITING)
    become(entry, v1::GOAL_WAITING, v1::CODE_NONE,
           "waits for " + who +
               (more ? ""
                     : "; with a priority of " + std::to_string(std::int64_t{front.priority} + 1) +
                           " it would go first"));
  else
    suspend(entry, v1::CODE_PREEMPTED, "interrupted by " + who);
  entry.status.waits_for = front.id;
}

void Executor::begin(Entry& entry) {
  entry.before = false;
  if (entry.status.state != v1::GOAL_UNDERWAY) {
    become(entry, v1::GOAL_UNDERWAY, v1::CODE_NONE, {});
    if (entry.node != 0)
      forest_.resume(entry.node);
  }
  if (entry.node != 0)
    return;
  entry.node = forest_.plant(entry.goal.id, describe(entry.goal.id), entry.goal.functor,
                             entry.schema->make(entry.arguments), entry.schema->priority,
                             entry.schema->timeout, entry.schema->concurrent);
}

const Goal* Executor::goal(const GoalId& id) const {
  const auto found = entries_.find(id);
  return found == entries_.end() ? nullptr : &found->second.goal;
}

bool Executor::interrupt(std::uint32_t node) {
  if (!forest_.contains(node))
    return false;
  forest_.interrupt(node, Hold::kPerson);
  return true;
}

const Value* Executor::variable(std::uint32_t node, std::string_view name) {
  return forest_.is_activity(node) ? forest_.activity(node).variable(name) : nullptr;
}

bool Executor::resume(std::uint32_t node) {
  if (!forest_.held(node, Hold::kPerson))
    return false;
  forest_.resume(node, Hold::kPerson);
  return true;
}

/// Updates the goals from the step; true where one has ended.
bool Executor::collect() {
  const std::map<std::uint32_t, Outcome> outcomes = forest_.take_ended();
  bool any = false;
  for (auto& [id, entry] : entries_) {
    if (entry.node == 0)
      continue;
    if (const auto outcome = outcomes.find(entry.node); outcome != outcomes.end()) {
      entry.node = 0;
      const bool success = outcome->second.state == IntentionState::kSuccess;
      end(entry, success ? v1::GOAL_SUCCEEDED : v1::GOAL_FAILED, outcome->second.code,
          outcome->second.reason);
      any = true;
    } else if (entry.status.state == v1::GOAL_UNDERWAY) {
      entry.status.step = forest_.held(entry.node, Hold::kPerson)
                              ? "interrupted by a person; waits to be resumed"
                              : step_of(forest_.foremost(entry.node));
      entry.status.progress = forest_.progress_of(entry.node);
      const double level = forest_.level_of(entry.node);
      if (entry.goal.level > 0.0 && level >= entry.goal.level) {
        entry.status.level = level;
        end(entry, v1::GOAL_SUCCEEDED, v1::CODE_NONE,
            "satisfied to " + plain(level) + ", " + plain(entry.goal.level) + " was asked for");
        any = true;
      }
    }
  }
  return any;
}

}  // namespace saphira::intentions
