#include "saphira/agent_interface/triggers.hpp"

#include <algorithm>
#include <limits>

#include "saphira/base/numbers.hpp"

namespace saphira::agent_interface {
namespace {

constexpr std::size_t kFired = 1024;     // triggers whose firings are remembered
constexpr double kShortestPeriod = 0.1;  // [s]
constexpr std::uint64_t kCalledOff = std::numeric_limits<std::uint64_t>::max();  // firings: no more

}  // namespace

std::string Triggers::set(const Trigger& trigger, double now) {
  if (trigger.kind != TriggerKind::event && !(trigger.period >= kShortestPeriod))
    return "period: expected 0.1 s or more, found " + plain(trigger.period);
  const double first = trigger.kind == TriggerKind::time ? trigger.period : 0.0;
  armed_[trigger.id] = {trigger, now + first};
  return {};
}

void Triggers::take_back(const Id& trigger) {
  armed_.erase(trigger);
  changed_ = fired_.erase(trigger) > 0 || changed_;
}

void Triggers::call_off(const Id& trigger) {
  fired_[trigger] = kCalledOff;
  changed_ = true;
}

const Trigger* Triggers::find(const Id& trigger) const {
  const auto found = armed_.find(trigger);
  return found == armed_.end() ? nullptr : &found->second.trigger;
}

std::vector<const Trigger*> Triggers::live() const {
  std::vector<const Trigger*> live;
  for (const auto& [id, armed] : armed_)
    if (!is_spent(armed.trigger))
      live.push_back(&armed.trigger);
  return live;
}

std::vector<const Trigger*> Triggers::take_due(double now) {
  std::vector<const Trigger*> due;
  for (auto& [id, armed] : armed_) {
    if (armed.trigger.kind == TriggerKind::event || now < armed.next || is_spent(armed.trigger))
      continue;
    // Times that this program slept through are skipped.
    armed.next = now + armed.trigger.period;
    due.push_back(&armed.trigger);
  }
  return due;
}

std::optional<double> Triggers::due() const {
  std::optional<double> soonest;
  for (const auto& [id, armed] : armed_)
    if (armed.trigger.kind != TriggerKind::event && !is_spent(armed.trigger) &&
        (!soonest || armed.next < *soonest))
      soonest = armed.next;
  return soonest;
}

std::vector<Firing> Triggers::happened(const std::string& functor, const Arguments& arguments) {
  std::vector<Firing> firings;
  for (const auto& [id, armed] : armed_) {
    const Trigger& trigger = armed.trigger;
    if (trigger.kind != TriggerKind::event || trigger.condition != functor)
      continue;
    const bool fits = std::all_of(
        trigger.condition_arguments.begin(), trigger.condition_arguments.end(),
        [&](const Argument& wanted) {
          const Argument* const has = saphira::find(arguments, wanted.name);
          return has != nullptr && (wanted.kind == ArgumentKind::unbound || *has == wanted);
        });
    if (!fits)
      continue;
    if (auto firing = fire(id, arguments))
      firings.push_back(std::move(*firing));
  }
  return firings;
}

std::optional<Firing> Triggers::looked(const Id& trigger, const Answer& answer) {
  const auto found = armed_.find(trigger);
  // An agent that is missing or silent leaves the value unknown; one that refuses has none.
  if (found == armed_.end() || !(well(answer.code) || answer.code == AnswerCode::refused))
    return std::nullopt;
  Armed& armed = found->second;
  std::optional<Arguments> value;
  if (well(answer.code))
    value = answer.results;
  const bool changed = armed.looked && value && armed.found != value;
  armed.looked = true;
  armed.found = value;
  return changed ? fire(trigger, answer.results) : std::nullopt;
}

std::optional<Firing> Triggers::fire(const Id& id, const Arguments& found) {
  const Trigger& trigger = armed_.at(id).trigger;
  if (is_spent(trigger))
    return std::nullopt;
  if (trigger.times != 0) {
    ++fired_[id];
    changed_ = true;
    const auto gone = std::find_if(fired_.begin(), fired_.end(),
                                   [this](const auto& one) { return !armed_.contains(one.first); });
    if (fired_.size() > kFired && gone != fired_.end())
      fired_.erase(gone);
  }
  Firing firing{&trigger};
  for (const Argument& argument : trigger.action_arguments) {
    const Argument* const value =
        argument.kind == ArgumentKind::unbound ? saphira::find(found, argument.name) : nullptr;
    firing.arguments.push_back(value == nullptr ? argument : *value);
  }
  return firing;
}

bool Triggers::is_spent(const Trigger& trigger) const {
  const auto fired = fired_.find(trigger.id);
  return fired != fired_.end() &&
         (fired->second == kCalledOff || (trigger.times != 0 && fired->second >= trigger.times));
}

}  // namespace saphira::agent_interface
