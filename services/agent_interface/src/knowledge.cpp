#include "saphira/agent_interface/knowledge.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "saphira/base/durable.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/maps/map.hpp"
#include "words.hpp"

namespace saphira::agent_interface {
namespace {

constexpr std::size_t kMost = 1024;
constexpr std::array<std::pair<Advice::Kind, const char*>, 4> kKinds{{
    {Advice::Kind::office_of, "office_of"},
    {Advice::Kind::person_at, "person_at"},
    {Advice::Kind::knows_where, "knows_where"},
    {Advice::Kind::hazard, "hazard"},
}};

/// Several pieces of advice of that kind may be true of one subject.
bool several(Advice::Kind kind) {
  return kind == Advice::Kind::hazard || kind == Advice::Kind::knows_where;
}

std::optional<double> parse_number(const std::string& text) {
  const auto value = number_in<double>(text);
  return value && *value >= 0.0 ? value : std::nullopt;
}

std::optional<Advice> read(std::string_view line) {
  const std::optional<std::string_view> content = unsealed_line(line);
  if (!content)
    return std::nullopt;
  const std::vector<std::string> parts = fields(*content);
  if (parts.size() != 8)
    return std::nullopt;
  const auto number = parse_number(parts[0]);
  const auto time = parse_number(parts[6]);
  const auto artifact = parse_number(parts[7]);
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(),
                                 [&](const auto& one) { return one.second == parts[1]; });
  if (!number || !time || !artifact || kind == kKinds.end())
    return std::nullopt;
  return Advice{static_cast<std::uint64_t>(*number),
                kind->first,
                parts[2],
                parts[3],
                parts[4],
                parts[5],
                *time,
                static_cast<std::uint32_t>(*artifact)};
}

}  // namespace

const char* describe(Advice::Kind kind) {
  for (const auto& [value, name] : kKinds)
    if (value == kind)
      return name;
  return "";
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
    return one.kind != Advice::Kind::hazard &&
           (one.about == person || (one.kind == Advice::Kind::knows_where && one.value == person));
  });
}

std::string Knowledge::save() const {
  std::string text;
  for (const Advice& one : all_)
    text += sealed_line(std::to_string(one.number) + "\t" + describe(one.kind) + "\t" +
                        field(one.about) + "\t" + field(one.value) + "\t" + field(one.speaker) +
                        "\t" + field(one.said) + "\t" + exact(one.time) + "\t" +
                        std::to_string(one.artifact)) +
            "\n";
  return text;
}

std::size_t Knowledge::restore(std::string_view text) {
  std::size_t bad = 0;
  while (!text.empty()) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    if (auto advice = read(text.substr(0, length))) {
      newest_ = std::max(newest_, advice->number);
      all_.push_back(std::move(*advice));
    } else if (length > 0) {
      ++bad;
    }
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return bad;
}

}  // namespace saphira::agent_interface
