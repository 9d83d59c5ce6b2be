#include "saphira/intentions/executor.hpp"

#include <cmath>
#include <tuple>
#include <utility>

#include "forest_node.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::intentions {
namespace {

/// The longest wait for the place of the robot, after a restart.
constexpr Ticks kFindsPlace = 50;
/// A goal from before a restart that is to be kept goes on then, though nobody asks for it again:
/// by then the withdrawals of programs that are there have come. The first step may be of ten.
constexpr Ticks kKept = 30;
/// Another one that is not heard for so long ends: its program is gone.
constexpr Ticks kUnheard = 6000;
/// [s] A goal of a program that is not heard waits so long for it: a network is back by then.
constexpr double kLostEnds = 10.0;
/// The publishing period of the status of an open goal.
constexpr Ticks kStatusPeriod = 10;
/// Goals that may begin in one cycle, each after the one before it ended in its first step.
constexpr int kBeginsPerCycle = 8;

/// A step after more cycles than this has slept meanwhile.
constexpr Ticks kLongestStep = 10;

/// Cycles for the trend of a level, and the least difference.
constexpr std::size_t kTrend = 20;
constexpr double kTrendStep = 0.02;

constexpr const char* kPositionLost =
    "position lost: the robot's dead reckoning has begun anew since the goal was accepted, so "
    "where "
    "the goal is cannot be told";

double seconds(Ticks ticks) {
  return kTick * static_cast<double>(ticks);
}

std::string name_of_goal(const Goal& goal) {
  constexpr std::size_t kLongest = 100;  // letters
  std::string name = goal.functor;
  if (const std::string arguments = describe(goal.arguments); !arguments.empty())
    name += " " + (arguments.size() > kLongest ? arguments.substr(0, kLongest) + "..." : arguments);
  if (!goal.requester.empty())
    name += " of " + quoted(goal.requester);
  return name;
}

/// True where an observer needs to know at once.
bool differs(const GoalStatus& a, const GoalStatus& b) {
  return a.state != b.state || a.code != b.code || a.reason != b.reason || a.step != b.step ||
         a.requester != b.requester || a.functor != b.functor || a.note != b.note ||
         a.waits_for != b.waits_for;
}

bool open(const GoalStatus& status) {
  return !ended(status.state);
}

/// A point that is fixed in odom when the goal is accepted. A point on the map stays there.
bool to_be_placed(const Argument& argument) {
  return argument.kind == ArgumentKind::point && argument.frame != Frame::map;
}

/// To the saved length. Characters of more than one byte stay whole.
std::string shortened(const std::string& reason) {
  if (reason.size() <= kLongestReason)
    return reason;
  std::size_t end = kLongestReason - 3;
  while (end > 0 && (static_cast<unsigned char>(reason[end]) & 0xc0U) == 0x80U)
    --end;
  return reason.substr(0, end) + "...";
}

}  // namespace

Executor::Executor(Registry registry, const Memory& memory, ExecutorOptions options)
    : options_(std::move(options)), registry_(std::make_shared<Registry>(std::move(registry))) {
  if (!options_.functions)
    options_.functions = std::make_shared<const Functions>(core_functions());
  beliefs_ = std::make_shared<Beliefs>(options_.functions.get());
  forest_ = Forest(registry_, beliefs_, options_.forest);
  for (const Ending& ending : memory.endings)
    remember(ending);
  const Work& work = memory.work;
  if (work.epoch == 0)
    return;
  stops_ = Stops(work.heeds);
  epoch_ = work.epoch;
  cycle_ = work.cycle;
  odom_ = work.odom;
  now_ = work.now;
  awake_ = recalled_ = work.awake;
  was_placed_ = work.placed;
  forest_.begin_after(work.last_intention, awake_);
  unheard_ = work.goals;
  std::erase_if(unheard_, [&](const auto& each) { return remembered_.contains(each.first); });
  for (const auto& [id, entry] : unheard_)
    next_order_ = std::max(next_order_, entry.order + 1);
  for (const Belief& belief : work.beliefs)
    beliefs_->set(belief.name, belief.value, belief.said_by, belief.since);
}

void Executor::archive(Archive& a) {
  a("beliefs", *beliefs_)("entries", entries_)("unheard", unheard_)("was_placed", was_placed_)(
      "set_revision", set_revision_)("remembered", remembered_)(
      "remembered_order", remembered_order_)("ended_order", ended_order_)(
      "next_order", next_order_)("now", now_)("awake", awake_)("epoch", epoch_)("cycle", cycle_)(
      "robot_here", robot_here_)("on_map", on_map_)("recalled", recalled_)("person", person_)(
      "stops", stops_)("odom", odom_)("withdrawn", withdrawn_)("endings", endings_)("other_epoch",
                                                                                    other_epoch_);
  if (a.restores())
    for (auto& [id, entry] : entries_) {
      entry.schema = registry_->share(entry.goal.functor);
      a.expect(entry.schema || !open(entry.status), "no activity " + entry.goal.functor);
    }
  struct InForest {
    Executor& self;
    void archive(Archive& in) {
      self.forest_.archive(in, [&](std::uint32_t root) {
        for (const auto& [id, entry] : self.entries_)
          if (entry.node == root && entry.schema)
            return entry.schema->make(entry.arguments);
        in.fail("a goal for each tree");
      });
    }
  } forest{*this};
  a("forest", forest);
}

void Executor::remember(const Ending& ending) {
  if (remembered_.insert_or_assign(ending.id, ending).second)
    remembered_order_.push_back(ending.id);
  while (remembered_order_.size() > options_.max_ended) {
    remembered_.erase(remembered_order_.front());
    remembered_order_.pop_front();
  }
}

GoalUpdates Executor::take_events(const std::vector<GoalEvent>& events) {
  for (const GoalEvent& event : events)
    take_in(event);
  forget_ended();
  return take_updates();
}

/// Withdraws goals that ended long ago, and the oldest where there are too many: without a robot no
/// time passes. Published goals only.
void Executor::forget_ended() {
  while (!ended_order_.empty()) {
    const auto oldest = entries_.find(ended_order_.front());
    const std::optional<GoalStatus>& told = oldest->second.published;
    const bool many = ended_order_.size() > options_.max_shown && told && !open(*told);
    if (!many && seconds(now_ - oldest->second.ended) < options_.keep_ended)
      return;
    withdrawn_.push_back(oldest->first);
    entries_.erase(oldest);
    ended_order_.pop_front();
  }
}

GoalUpdates Executor::robot_gone() {
  lose_robot();
  return take_updates();
}

Outputs Executor::step(const Inputs& inputs) {
  pass_time(inputs);
  for (const GoalEvent& event : inputs.events)
    take_in(event);
  settle_unheard();
  for (auto& [id, entry] : entries_) {
    if (std::exchange(entry.fresh, false))
      entry.accepted = now_;
    if (open(entry.status))
      entry.status.elapsed = seconds(now_ - entry.accepted);
  }
  robot_here_ = inputs.robot.connected && inputs.hold.empty();
  on_map_ = inputs.robot.odom_in_map.has_value();
  person_ = inputs.person;
  if (robot_here_) {
    meet_odom(inputs.robot.odom);
    for (auto& [id, entry] : entries_) {
      if (open(entry.status) && !entry.placed)
        place(entry, inputs.robot);
    }
    pass_changes();
  } else {
    lose_robot(inputs.robot.connected ? inputs.hold : std::string());
  }
  end_lost();
  check_deadlines(inputs.robot);
  replace();
  if (!inputs.estop.empty())
    end_driving("emergency stop, pressed by " + quoted(inputs.estop) +
                ": ask anew once it is released");
  obey_stop(inputs);
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
  if (robot_here_) {
    arbitrate();
    begin_concurrent();
  }
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
  Outputs outputs{forest_.behaviors(),        forest_.nodes(),     take_updates(),
                  forest_.behavior_control(), forest_.take_said(), forest_.take_requests(),
                  forest_.take_questions()};
  outputs.updates.work = take_work(!outputs.updates.changed.empty());
  outputs.stop = stops_.asks(now_, inputs.confirms_stops);
  return outputs;
}

void Executor::pass_time(const Inputs& inputs) {
  Ticks passed = 0;
  other_epoch_ = other_epoch_ || inputs.epoch != epoch_;
  if (inputs.epoch != epoch_)
    passed = epoch_ == 0 ? 0 : 1;
  else if (inputs.cycle > cycle_)
    passed = static_cast<Ticks>(inputs.cycle - cycle_);
  now_ += passed;
  awake_ += std::min(passed, kLongestStep);
  epoch_ = inputs.epoch;
  cycle_ = inputs.cycle;
}

// --- goals from the bus

void Executor::take_in(const GoalEvent& event) {
  if (event.kind == GoalEvent::Kind::kWritten) {
    take_written(event);
    return;
  }
  auto found = entries_.find(event.goal.id);
  if (found == entries_.end() && event.kind == GoalEvent::Kind::kDisposed)
    found = take_up(event.goal.id);
  if (found == entries_.end() || !open(found->second.status))
    return;
  Entry& entry = found->second;
  if (event.kind == GoalEvent::Kind::kDisposed) {
    end(entry, v1::GOAL_CANCELED, v1::CODE_DISPOSED,
        (event.by.empty() && !event.why.empty()
             ? std::string("withdrawn")
             : "withdrawn by " + (event.by.empty() ? "its requester" : event.by)) +
            (event.why.empty() ? "" : ": " + event.why));
  } else if (entry.goal.writer_lost == v1::WRITER_LOST_CANCEL && !entry.lost) {
    entry.lost = now_;
  }
}

void Executor::take_written(const GoalEvent& event) {
  const Goal& goal = event.goal;
  auto found = entries_.find(goal.id);
  if (found == entries_.end() && event.forgotten.empty())
    found = take_up(goal.id);
  if (found != entries_.end()) {
    Entry& entry = found->second;
    if (!open(entry.status))
      return;  // an ended goal stays ended: its id is not used again
    entry.lost.reset();
    if (goal != entry.goal)
      change(entry, event);
    else
      entry.refusal.clear();  // taken back
    return;
  }
  unheard_.erase(goal.id);
  Entry& entry = entries_[goal.id];
  entry.goal = goal;
  entry.accepted = now_;
  entry.order = next_order_++;
  entry.status.id = goal.id;
  entry.status.requester = goal.requester;
  entry.status.functor = goal.functor;

  if (const auto done = remembered_.find(goal.id); done != remembered_.end()) {
    become(entry, done->second.state, done->second.code, done->second.reason);
    entry.status.progress = done->second.state == v1::GOAL_SUCCEEDED ? 1.0 : 0.0;
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
    const auto count = std::count_if(entries_.begin(), entries_.end(),
                                     [](const auto& each) { return open(each.second.status); });
    if (static_cast<std::size_t>(count) > options_.max_open) {
      code = v1::CODE_TOO_MANY;
      wrong = "too many goals: " + std::to_string(options_.max_open) + " are open already";
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
    wait(entry, v1::CODE_NO_ROBOT, "accepted; waits for the robot");
  else
    wait(entry, v1::CODE_NONE, "accepted");
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
    forest_.remove(entry.node);
    entry.node = 0;
    entry.replaced = false;
  }
  if (arguments) {
    put_up(entry, goal, std::move(complete));
    entry.changed = entry.node != 0;
    entry.unapproved = event.needs_approval && !entry.schema->replaces;
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

// --- states

void Executor::become(Entry& entry, GoalState state, GoalCode code, std::string reason) {
  entry.status.state = state;
  entry.status.code = code;
  entry.status.reason = std::move(reason);
  entry.status.waits_for = {};
}

void Executor::end(Entry& entry, GoalState state, GoalCode code, std::string reason) {
  if (entry.node != 0)
    forest_.remove(entry.node);
  entry.node = 0;
  entry.ended = now_;
  ended_order_.push_back(entry.goal.id);
  become(entry, state, code, reason.empty() ? word_of(state) : std::move(reason));
  entry.status.step.clear();
  if (state == v1::GOAL_SUCCEEDED)
    entry.status.progress = 1.0;
  const Ending ending{entry.goal.id, state, code, shortened(entry.status.reason)};
  remember(ending);
  endings_.push_back(ending);
}

void Executor::wait(Entry& entry, GoalCode code, std::string reason) {
  become(entry, v1::GOAL_WAITING, code, std::move(reason));
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
    wait(entry, code, hold.empty() ? "waits for the robot" : hold);
  else if (open(entry.status))
    suspend(entry, code, hold.empty() ? "the robot is not heard; goes on when it is" : hold);
}

void Executor::meet_odom(std::uint64_t odom) {
  if (odom_ && *odom_ != odom) {
    for (auto& [id, entry] : entries_)
      meet_odom(entry, odom);
    // A text is no place in the earlier frame.
    for (const Belief& belief : lasting_beliefs())
      if (belief.value.text() == nullptr)
        beliefs_->unset(belief.name);
  }
  odom_ = odom;
}

void Executor::meet_odom(Entry& entry, std::uint64_t odom) {
  if (open(entry.status) && entry.odom && *entry.odom != odom)
    end(entry, v1::GOAL_FAILED, v1::CODE_NO_ROBOT, kPositionLost);
  // Its memory has places in the earlier odom: it begins anew.
  if (open(entry.status) && entry.node != 0 && entry.schema->program) {
    forest_.remove(entry.node);
    entry.node = 0;
    entry.status.note =
        "was begun anew at its first step: the robot's dead reckoning has begun anew";
  }
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
    forest_.remove(entry.node);
    entry.node = 0;
  }
}

void Executor::end_lost() {
  for (auto& [id, entry] : entries_)
    if (open(entry.status) && entry.lost && seconds(now_ - *entry.lost) >= kLostEnds)
      end(entry, v1::GOAL_CANCELED, v1::CODE_WRITER_LOST,
          "the program that asked for it is gone, or was cut off for " + plain(kLostEnds) + " s");
}

void Executor::check_deadlines(const Robot& robot) {
  for (auto& [id, entry] : entries_) {
    if (!open(entry.status) || entry.goal.deadline <= 0.0)
      continue;
    // Half a tick of slack, for the rounding of the sum.
    if (seconds(now_ - entry.accepted) + 0.5 * kTick < entry.goal.deadline)
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
    if (!open(stop.status) || !stop.schema->replaces || stop.replaced)
      continue;
    stop.replaced = true;
    stops_.ask(stop.goal.requester, now_);
    for (auto& [other_id, other] : entries_) {
      const bool earlier =
          std::pair(other.accepted, other.order) < std::pair(stop.accepted, stop.order);
      if (open(other.status) && drives(other) && earlier) {
        end(other, v1::GOAL_CANCELED, v1::CODE_STOPPED, "stopped by " + name_of_goal(stop.goal));
        other.status.waits_for = id;
      }
    }
  }
}

void Executor::obey_stop(const Inputs& inputs) {
  if (stops_.take(inputs.stop, inputs.stop_was_before))
    end_driving("stopped by " + inputs.stop_source + ": ask anew to have it done");
  if (std::none_of(entries_.begin(), entries_.end(), [](const auto& each) {
        return open(each.second.status) && each.second.schema->replaces;
      }))
    stops_.give_up(inputs.confirms_stops);
}

/// Goals that have been stopped do not go on by themselves.
void Executor::end_driving(const std::string& why) {
  for (auto& [id, entry] : entries_)
    if (open(entry.status) && drives(entry))
      end(entry, v1::GOAL_CANCELED, v1::CODE_STOPPED, why);
  std::vector<GoalId> driving;
  for (const auto& [id, entry] : unheard_)
    if (const Schema* const schema = registry_->find(entry.goal.functor);
        schema == nullptr || (!schema->concurrent && !schema->replaces))
      driving.push_back(id);
  for (const GoalId& id : driving)
    end_unheard(id, v1::CODE_STOPPED, why);
}

/// The present work of an intention, for people: an activity of the language uses the words of its
/// schema.
std::string Executor::step_of(const IntentionNode& node) const {
  const Schema* const schema = registry_->find(node.schema);
  if (schema == nullptr || schema->program == nullptr)
    return node.step;
  if (!schema->summary.empty())
    return schema->name + ": " + schema->summary;
  // Its step is an awaited condition, or a goal in code, which is not for people.
  return node.step.empty() || node.step.front() == '(' ? schema->name : node.step;
}

/// Neither a stop nor a goal beside the driving one.
bool Executor::drives(const Entry& entry) {
  return !entry.schema->concurrent && !entry.schema->replaces;
}

bool Executor::approve(const GoalId& id) {
  const auto found = entries_.find(id);
  return found != entries_.end() && open(found->second.status) &&
         std::exchange(found->second.unapproved, false);
}

/// Why the goal waits: its program is not heard, it is not approved, or it drives while a person
/// has the robot. Empty: it does not. A stop and concurrent goals go on beside a person.
std::string Executor::why_to_wait(const Entry& entry) const {
  if (entry.lost && drives(entry))
    return "the program that asked for it is not heard: it goes on when that is, and ends after " +
           plain(kLostEnds) + " s";
  if (entry.unapproved)
    return "waits for a person's approval: saphira goal approve " + describe(entry.goal.id);
  // After a restart registration is heard some cycles later.
  if (entry.before && was_placed_ && !on_map_ && awake_ < recalled_ + kFindsPlace)
    return "waits until it is known where the robot is";
  return drives(entry) ? person_ : std::string();
}

Executor::Entry* Executor::best() {
  const auto rank = [](const Entry& entry) {
    return std::tuple(-static_cast<std::int64_t>(entry.goal.priority), entry.accepted, entry.order);
  };
  Entry* best = nullptr;
  for (auto& [id, entry] : entries_) {
    if (open(entry.status) && !entry.schema->concurrent && why_to_wait(entry).empty() &&
        (best == nullptr || rank(entry) < rank(*best)))
      best = &entry;
  }
  return best;
}

/// Gives the robot to the best goal; returns the goal that is underway now, nullptr: none.
Executor::Entry* Executor::arbitrate() {
  for (auto& [id, entry] : entries_) {
    const std::string why = open(entry.status) ? why_to_wait(entry) : std::string();
    if (why.empty())
      continue;
    const bool waiting = entry.status.state == v1::GOAL_WAITING;
    const GoalCode code = entry.lost         ? v1::CODE_WRITER_LOST
                          : entry.unapproved ? v1::CODE_APPROVAL
                          : waiting          ? v1::CODE_NONE
                                             : v1::CODE_PREEMPTED;
    waiting ? wait(entry, code, why) : suspend(entry, code, why);
  }
  Entry* const chosen = best();
  if (chosen == nullptr)
    return nullptr;
  for (auto& [id, entry] : entries_) {
    if (open(entry.status) && &entry != chosen && !entry.schema->concurrent &&
        why_to_wait(entry).empty())
      queue(entry, chosen->goal);
  }
  begin(*chosen);
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
    wait(entry, v1::CODE_NONE,
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

/// Takes up a goal from before the restart of the service; end(): there is none that can go on.
Executor::Entries::iterator Executor::take_up(const GoalId& id) {
  const auto unheard = unheard_.find(id);
  if (unheard == unheard_.end())
    return entries_.end();
  std::shared_ptr<const Schema> schema = registry_->share(unheard->second.goal.functor);
  Arguments complete;
  if (!schema || !check_arguments(*schema, unheard->second.arguments, complete).empty())
    return entries_.end();
  auto known = unheard_.extract(unheard);
  Entry& entry = known.mapped();
  entry.schema = std::move(schema);
  entry.before = true;
  try {
    if (entry.node != 0)
      forest_.restore(entry.node, std::exchange(entry.tree, {}),
                      [&](std::uint32_t) { return entry.schema->make(entry.arguments); });
  } catch (const std::runtime_error& error) {
    entry.node = 0;
    // A built-in only needs its arguments, which are places and headings.
    if (entry.schema->program)
      entry.status.note =
          std::string("was begun anew at its first step: intentions was restarted, and ") +
          error.what();
  }
  lose_robot(entry, robot_here_ ? "goes on" : "");
  if (odom_ && entry.frame != *odom_)
    meet_odom(entry, *odom_);
  return entries_.insert(std::move(known)).position;
}

/// Goals from before a restart that nobody has asked for again. A goal that is to be kept goes on,
/// unless the bridge was started again as well: a robot does not set out by itself once it is
/// switched on.
void Executor::settle_unheard() {
  const Ticks waited = awake_ - recalled_;
  std::vector<GoalId> due;
  for (const auto& [id, entry] : unheard_)
    if (waited > kUnheard || (waited >= kKept && entry.goal.writer_lost == v1::WRITER_LOST_KEEP))
      due.push_back(id);
  for (const GoalId& id : due) {
    const bool kept = unheard_.at(id).goal.writer_lost == v1::WRITER_LOST_KEEP;
    if (kept && !other_epoch_)
      if (const auto found = take_up(id); found != entries_.end()) {
        std::string& told = found->second.status.note;
        told += (told.empty() ? "" : ", and ") +
                std::string("is kept: intentions was restarted, and nobody asks for it any more");
        continue;
      }
    end_unheard(id, v1::CODE_WRITER_LOST,
                std::string("intentions was restarted, and the program that asked for it has not "
                            "been heard since") +
                    (!kept          ? ""
                     : other_epoch_ ? "; it was to be kept, and the bridge was restarted as well: "
                                      "ask again"
                                    : "; it was to be kept, and its activity is another now"));
  }
}

void Executor::end_unheard(const GoalId& id, GoalCode code, const std::string& why) {
  auto known = unheard_.extract(id);
  Entry& entry = known.mapped();
  entry.node = 0;
  entry.tree = {};
  end(entries_.insert(std::move(known)).position->second, v1::GOAL_CANCELED, code, why);
}

const Goal* Executor::goal(const GoalId& id) const {
  for (const Entries* const among : {&entries_, &unheard_})
    if (const auto found = among->find(id); found != among->end())
      return &found->second.goal;
  return nullptr;
}

/// That activities have set, without those that end with an intention: they are saved with it.
std::vector<Belief> Executor::lasting_beliefs() const {
  std::vector<Belief> beliefs = beliefs_->set_by_activities();
  std::erase_if(beliefs, [&](const Belief& belief) {
    return normal(belief.name) == kBehaviorControl || forest_.ends_with_intention(belief.name);
  });
  return beliefs;
}

std::optional<Work> Executor::take_work(bool changed) {
  changed = forest_.take_changed() || changed;
  const bool set = set_revision_ != beliefs_->set_revision();
  set_revision_ = beliefs_->set_revision();
  const bool stopped = stops_.take_changed();
  if (!options_.remembers_work || !odom_ || !(changed || set || stopped))
    return std::nullopt;
  Work work{epoch_, cycle_, *odom_, now_, awake_, forest_.last_id(), unheard_, lasting_beliefs()};
  work.heeds = stops_.heeds();
  work.placed = on_map_ || was_placed_;
  if (!remembered_order_.empty())
    work.ended = remembered_order_.back();
  for (const auto& [id, entry] : entries_) {
    if (!open(entry.status))
      continue;
    Entry& saved = work.goals[id] = entry;
    saved.published.reset();
    saved.frame = *odom_;
    if (entry.node != 0)
      saved.tree = forest_.save(entry.node);
  }
  return work;
}

/// Goals underway beside the driving one, from the cycle of their arrival on.
void Executor::begin_concurrent() {
  for (auto& [id, entry] : entries_) {
    if (open(entry.status) && entry.schema->concurrent && !entry.unapproved)
      begin(entry);
  }
}

void Executor::add(Schema schema) {
  registry_->add(std::move(schema));
}

void Executor::remove(std::string_view name) {
  registry_->remove(name);
}

void Executor::know_behaviors(std::vector<BehaviorSignature> behaviors) {
  registry_->know_behaviors(std::move(behaviors));
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

/// Updates the goal's satisfaction.
void Executor::measure(Entry& entry) {
  GoalStatus& status = entry.status;
  if (status.state != v1::GOAL_UNDERWAY || entry.node == 0) {
    if (status.state == v1::GOAL_SUCCEEDED && entry.goal.level <= 0.0)
      status.level = 1.0;
    status.trend = v1::TREND_STEADY;
    entry.levels.clear();
    return;
  }
  status.level = forest_.level_of(entry.node);
  entry.levels.push_back(status.level);
  if (entry.levels.size() > kTrend)
    entry.levels.pop_front();
  const double change = status.level - entry.levels.front();
  status.trend = change > kTrendStep    ? v1::TREND_RISING
                 : change < -kTrendStep ? v1::TREND_FALLING
                                        : v1::TREND_STEADY;
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

/// The status with the refusal of the newest change; nothing: it was not refused.
std::optional<GoalStatus> Executor::refused_change(const Entry& entry) {
  if (entry.refusal.empty())
    return std::nullopt;
  GoalStatus status = entry.status;
  status.reason += (status.reason.empty() ? "goes on unchanged, " : "; ");
  status.reason += "the change was refused: " + entry.refusal;
  // Only where the state has no reason of its own: what it waits for has its member.
  if (status.code == v1::CODE_NONE || status.waits_for != GoalId{})
    status.code = entry.refusal_code;
  return status;
}

GoalUpdates Executor::take_updates() {
  GoalUpdates updates;
  for (auto& [id, entry] : entries_) {
    const std::optional<GoalStatus> refused = refused_change(entry);
    const GoalStatus& status = refused ? *refused : entry.status;
    const bool due = open(status) && now_ - entry.published_at >= kStatusPeriod;
    if (entry.published && !due && !differs(*entry.published, status))
      continue;
    entry.published = status;
    entry.published_at = now_;
    updates.changed.push_back(status);
  }
  updates.withdrawn = std::exchange(withdrawn_, {});
  updates.endings = std::exchange(endings_, {});
  return updates;
}

}  // namespace saphira::intentions
