#include "saphira/agent_interface/knowledge.hpp"

#include <algorithm>
#include <utility>

#include "saphira/base/enumerators.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::agent_interface {
namespace {

constexpr std::size_t kMost = 1024;
/// Several pieces of advice of that kind may be true of one subject.
bool several(Advice::Kind kind) {
  return kind == Advice::Kind::hazard || kind == Advice::Kind::knows_where;
}

}  // namespace

const char* describe(Advice::Kind kind) {
  return word_of(kind, {"office_of", "person_at", "knows_where", "hazard", "has"});
}

std::string describe(const Advice& advice) {
  switch (advice.kind) {
    case Advice::Kind::office_of: {
      const std::string office = advice.about + "'s office";
      // A place without a name got this one.
      return advice.value == office ? office + " is on my map" : advice.value + " is " + office;
    }
    case Advice::Kind::person_at:
      return advice.about + " is at " + advice.value;
    case Advice::Kind::knows_where:
      return advice.value + " knows where " + advice.about + " is";
    case Advice::Kind::has:
      return advice.value + " has " + advice.about;
    case Advice::Kind::hazard:
      break;
  }
  const auto rule = maps::zone_rule(advice.about);
  if (rule == maps::ZoneRule::keep_out)
    return "I am to keep out of " + advice.value;
  if (rule == maps::ZoneRule::slow)
    return "I am to go slowly in " + advice.value;
  if (rule == maps::ZoneRule::preferred)
    return "I am to prefer " + advice.value;
  return (advice.about == "broken glass" ? "there is " : "there is a ") + advice.about + " at " +
         advice.value;
}

const Advice* Knowledge::find(Advice::Kind kind, std::string_view about,
                              std::string_view value) const {
  for (const Advice& one : all_)
    if (one.kind == kind && one.about == about &&
        (!several(kind) || value.empty() || one.value == value))
      return &one;
  return nullptr;
}

const Advice& Knowledge::learn(Advice advice) {
  std::erase_if(all_, [&](const Advice& one) {
    return one.kind == advice.kind && one.about == advice.about &&
           (!several(one.kind) || one.value == advice.value);
  });
  if (all_.size() >= kMost)
    all_.erase(all_.begin());
  advice.number = ++newest_;
  return all_.emplace_back(std::move(advice));
}

std::optional<Advice> Knowledge::forget(std::uint64_t number) {
  const auto found = std::find_if(all_.begin(), all_.end(),
                                  [&](const Advice& one) { return one.number == number; });
  if (found == all_.end())
    return std::nullopt;
  Advice forgotten = std::move(*found);
  all_.erase(found);
  return forgotten;
}

std::string Knowledge::place_of(std::string_view person) const {
  for (const Advice::Kind kind : {Advice::Kind::person_at, Advice::Kind::office_of})
    if (const Advice* const advice = find(kind, person))
      return advice->value;
  return {};
}

bool Knowledge::findable(std::string_view person) const {
  return !place_of(person).empty() || find(Advice::Kind::knows_where, person) != nullptr;
}

bool Knowledge::knows(std::string_view person) const {
  return std::any_of(all_.begin(), all_.end(), [&](const Advice& one) {
    return one.kind != Advice::Kind::hazard && one.kind != Advice::Kind::has &&
           (one.about == person || (one.kind == Advice::Kind::knows_where && one.value == person));
  });
}

}  // namespace saphira::agent_interface
