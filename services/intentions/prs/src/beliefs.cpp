#include "saphira/intentions/beliefs.hpp"

#include <utility>

#include "saphira/intentions/functions.hpp"

namespace saphira::intentions {
namespace {

/// Maximum of simultaneous claims of third parties; further ones are ignored.
constexpr std::size_t kMostClaims = 1024;
constexpr std::size_t kMostSet = 4096;

}  // namespace

void Beliefs::evaluate_conditions(const World& world) {
  if (functions_ == nullptr)
    return;
  looked_ = world.now;
  auto at = conditions_.begin();  // it has the same order of names
  for (const auto& [name, condition] : functions_->conditions()) {
    Value value = condition.value(world);
    if (at != conditions_.end() && at->first != name)
      at = conditions_.lower_bound(name);
    if (at != conditions_.end() && at->first == name && at->second.value == value) {
      ++at;
      continue;
    }
    Belief belief{condition.name, std::move(value), "perception", world.now};
    at = conditions_.insert_or_assign(at, name, std::move(belief));
    ++revision_;
  }
}

void Beliefs::set(std::string_view name, Value value, std::string_view who, Ticks now) {
  std::string key = normal(name);
  const auto found = set_.find(key);
  // A repeated value counts where a claim has covered it meanwhile.
  if (found != set_.end() && found->second.value == value && found->second.said_by == who &&
      stored(key) == &found->second)
    return;
  if (found == set_.end() && set_.size() >= kMostSet)
    return;
  set_[std::move(key)] = {std::string(name), std::move(value), std::string(who), now};
  ++revision_;
  ++set_revision_;
}

void Beliefs::unset(std::string_view name) {
  if (set_.erase(normal(name)) == 0)
    return;
  ++revision_;
  ++set_revision_;
}

void Beliefs::take(const ClaimEvent& event, Ticks now) {
  for (auto claims = claims_.begin(); claims != claims_.end();) {
    const std::size_t gone =
        std::erase_if(claims->second, [&](const Claim& claim) { return claim.id == event.id; });
    claim_count_ -= gone;
    if (gone > 0)
      ++revision_;
    claims = claims->second.empty() ? claims_.erase(claims) : std::next(claims);
  }
  if (event.kind == ClaimEvent::Kind::kWithdrawn || claim_count_ >= kMostClaims)
    return;
  claims_[normal(event.name)].push_back(
      {event.id, {event.name, event.value, event.source, now - event.age}});
  ++claim_count_;
  ++revision_;
}

const Belief* Beliefs::stored(std::string_view name) const {
  const auto set = set_.find(name);
  const auto claims = claims_.find(name);
  const Belief* const mine = set == set_.end() ? nullptr : &set->second;
  const Belief* const claimed = claims == claims_.end() ? nullptr : &claims->second.back().belief;
  if (mine == nullptr || claimed == nullptr)
    return mine == nullptr ? claimed : mine;
  return claimed->since >= mine->since ? claimed : mine;
}

Value Beliefs::get(std::string_view name, const World& world) const {
  if (functions_ != nullptr) {
    if (looked_ == world.now) {
      if (const auto found = conditions_.find(name); found != conditions_.end())
        return found->second.value;
    } else if (const Condition* const condition = functions_->condition(name)) {
      return condition->value(world);
    }
  }
  const Belief* const belief = stored(name);
  return belief == nullptr ? Value() : belief->value;
}

std::vector<Belief> Beliefs::set_by_activities() const {
  std::vector<Belief> result;
  for (const auto& [name, belief] : set_)
    result.push_back(belief);
  return result;
}

std::vector<Belief> Beliefs::all() const {
  std::map<std::string_view, const Belief*> all;
  for (const auto& [name, belief] : set_)
    all[name] = stored(name);
  for (const auto& [name, claims] : claims_)
    all[name] = stored(name);
  for (const auto& [name, belief] : conditions_)
    all[name] = &belief;
  std::vector<Belief> result;
  result.reserve(all.size());
  for (const auto& [name, belief] : all)
    result.push_back(*belief);
  return result;
}

}  // namespace saphira::intentions
