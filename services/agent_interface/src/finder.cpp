// The search for the meanings of words: see config/grammars/README.md.
#include "finder.hpp"

#include <algorithm>
#include <set>

#include "words.hpp"

namespace saphira::agent_interface {
namespace {

constexpr std::size_t kLongestName = 5;  // words: "E J two thirty one"
constexpr std::size_t kMostMatches = 1000;
constexpr std::size_t kMostSteps = 8;  // of a sequence

/// Words as people write them: "karen's office".
std::string joined(const std::vector<std::string>& words, std::size_t from) {
  std::string text;
  for (std::size_t i = from; i < words.size(); ++i)
    text += (text.empty() || words[i] == "'s" ? "" : " ") + words[i];
  return text;
}

}  // namespace

std::vector<Grammar::Finder::Match> Grammar::Finder::entry(const Node& node,
                                                           const std::vector<std::string>& words,
                                                           const Match& from) const {
  std::vector<Match> matches;
  if (node.kind == Node::Kind::number && from.end < words.size() && is_number(words[from.end])) {
    matches.push_back(from);
    matches.back().end += 1;
    matches.back().slots[node.slot] = words[from.end];
  }
  const auto list = grammar_.lists_.find(node.text);
  if (list == grammar_.lists_.end())
    return matches;
  for (const Entry& one : list->second) {
    if (words.size() - from.end < one.words.size() ||
        !std::equal(one.words.begin(), one.words.end(),
                    words.begin() + static_cast<std::ptrdiff_t>(from.end)))
      continue;
    Match match = from;
    match.end += one.words.size();
    match.literal += one.words.size();
    if (!node.slot.empty())
      match.slots[node.slot] = one.value;
    matches.push_back(std::move(match));
  }
  if (node.kind != Node::Kind::number)
    return matches;
  if (const auto [number, count] = spoken_number(words, from.end); number > 0) {
    Match match = from;
    match.end += count;
    match.literal += count;
    match.slots[node.slot] = std::to_string(number);
    if (std::ranges::find(matches, match.end, &Match::end) == matches.end())
      matches.push_back(std::move(match));
  }
  if (const auto decimal = this->decimal(words, from.end)) {
    matches.push_back(from);
    matches.back().end += decimal->first;
    matches.back().literal += decimal->first;
    matches.back().slots[node.slot] = decimal->second;
  }
  return matches;
}

/// "One point two five": its number of words, and "1.25".
std::optional<std::pair<std::size_t, std::string>> Grammar::Finder::decimal(
    const std::vector<std::string>& words, std::size_t at) const {
  const auto value = [&](const std::string& list, std::size_t i) -> std::string {
    if (i < words.size() && is_number(words[i]))
      return words[i];
    if (const auto found = grammar_.lists_.find(list);
        i < words.size() && found != grammar_.lists_.end())
      for (const Entry& one : found->second)
        if (one.words.size() == 1 && one.words.front() == words[i])
          return one.value;
    return {};
  };
  std::string text = value("digit", at);
  if (text.empty())
    text = value("number", at);
  if (text.empty() || at + 1 >= words.size() || words[at + 1] != "point")
    return std::nullopt;
  std::size_t end = at + 2;
  text += ".";
  for (std::string digit = value("digit", end); !digit.empty(); digit = value("digit", end)) {
    text += digit;
    ++end;
  }
  if (end == at + 2 || !is_number(text))
    return std::nullopt;
  return std::pair(end - at, text);
}

bool Grammar::Finder::may_be_name(const std::string& word) const {
  const auto has = [&](const std::vector<std::string>& some) {
    return std::find(some.begin(), some.end(), word) != some.end();
  };
  return word != "'s" && !has(grammar_.no_names_) && !has(grammar_.keywords_);
}

/// A name is any word without another use. The grammar does not check that such a place or person
/// exists.
std::vector<Grammar::Finder::Match> Grammar::Finder::name(const Node& node,
                                                          const std::vector<std::string>& words,
                                                          const Match& from) const {
  std::vector<Match> matches;
  std::string text;
  std::size_t end = from.end;
  for (std::size_t length = 1; length <= kLongestName && end < words.size(); ++length) {
    // "Two hundred and twelve" has a word that no name has.
    const auto [number, count] = spoken_number(words, end);
    const bool hundreds = number >= 100;
    if (!hundreds && !may_be_name(words[end]))
      break;
    text += (text.empty() ? "" : " ") + (hundreds ? std::to_string(number) : words[end]);
    end += hundreds ? count : 1;
    matches.push_back(from);
    matches.back().end = end;
    matches.back().slots[node.slot] = text;
  }
  return matches;
}

std::vector<Grammar::Finder::Match> Grammar::Finder::sequence(const std::vector<Node>& parts,
                                                              const std::vector<std::string>& words,
                                                              const Match& from) {
  std::vector<Match> matches{from};
  for (const Node& part : parts) {
    std::vector<Match> next;
    for (const Match& match : matches) {
      const std::vector<Match> more = this->match(part, words, match);
      next.insert(next.end(), more.begin(), more.end());
      if (next.size() > kMostMatches)
        return {};
    }
    matches = std::move(next);
  }
  return matches;
}

std::vector<Grammar::Finder::Match> Grammar::Finder::match(const Node& node,
                                                           const std::vector<std::string>& words,
                                                           const Match& from) {
  std::vector<Match> matches;
  ++work;
  switch (node.kind) {
    case Node::Kind::word:
      if (from.end < words.size() && words[from.end] == node.text) {
        matches.push_back(from);
        ++matches.back().end;
        ++matches.back().literal;
      }
      return matches;
    case Node::Kind::list:
    case Node::Kind::number:
      return entry(node, words, from);
    case Node::Kind::name:
      return name(node, words, from);
    case Node::Kind::rest:
      if (from.end < words.size()) {
        matches.push_back(from);
        std::string& text = matches.back().slots[node.slot];
        text += (text.empty() ? "" : " ") + joined(words, from.end);
        matches.back().end = words.size();
      }
      return matches;
    case Node::Kind::sequence:
      return sequence(node.parts, words, from);
    case Node::Kind::optional:
      matches = match(node.parts.front(), words, from);
      matches.push_back(from);
      return matches;
    case Node::Kind::choice:
      for (const Node& part : node.parts) {
        const std::vector<Match> more = match(part, words, from);
        matches.insert(matches.end(), more.begin(), more.end());
      }
      return matches;
  }
  return matches;
}

std::vector<Meaning> Grammar::Finder::look(const std::vector<std::string>& words, bool addressed,
                                           bool replies, Use use) {
  if ((use == Use::reply ? !replies : !addressed) || words.empty())
    return {};
  ++work;
  if (is_spent())
    return {};
  const auto [known, is_new] = looked_.try_emplace({use, addressed, words});
  if (is_new)
    known->second = find(words, addressed, use);
  return known->second;
}

std::vector<Meaning> Grammar::Finder::find(const std::vector<std::string>& words, bool addressed,
                                           Use use) {
  const std::string& last = words.back();
  const bool number = is_number(last);
  const bool name = may_be_name(last);
  std::set<Place> places;
  const auto take = [&](const std::string& first) {
    if (const auto found = grammar_.begun_by_.find(first); found != grammar_.begun_by_.end())
      places.insert(found->second.begin(), found->second.end());
  };
  take(words.front());
  take(kAnyText);
  if (is_number(words.front()))
    take(kAnyNumber);
  if (may_be_name(words.front()))
    take(kAnyName);
  std::vector<Meaning> meanings;
  std::size_t best = 0;
  for (const auto& [rule_at, pattern_at] : places) {
    const Rule& rule = grammar_.rules_[rule_at];
    const Pattern& pattern = rule.patterns[pattern_at];
    ++work;
    if ((rule.use != use && (use != Use::command || rule.use != Use::typed)) ||
        (use != Use::urgent && !pattern.ends.contains(last) && !pattern.ends.contains(kAnyText) &&
         !(number && pattern.ends.contains(kAnyNumber)) &&
         !(name && pattern.ends.contains(kAnyName))))
      continue;
    for (const Match& match : this->match(pattern.node, words, {})) {
      // A mere name is a reply, not a word to the robot by its name.
      if ((match.end != words.size() && use != Use::urgent) || match.literal < best ||
          (match.literal == 0 && addressed))
        continue;
      Meaning meaning = rule.meaning;
      for (const auto& [slot, value] : match.slots)
        meaning.slots[slot] = value;
      // The meaning whose pattern explains more of the words is better.
      if (match.literal > best)
        meanings.clear();
      best = match.literal;
      if (std::find(meanings.begin(), meanings.end(), meaning) == meanings.end())
        meanings.push_back(std::move(meaning));
    }
  }
  return meanings;
}

std::vector<std::pair<Meaning, std::vector<std::string>>> Grammar::Finder::asides(
    const std::vector<std::string>& words, Use use) {
  std::vector<std::pair<Meaning, std::vector<std::string>>> found;
  if (is_spent())
    return {};
  const auto note = [&](std::size_t from, std::size_t to) {
    const auto at = [&](std::size_t i) { return words.begin() + static_cast<std::ptrdiff_t>(i); };
    const std::vector<Meaning> meanings =
        look(without_commas({at(from), at(to)}), true, false, use);
    std::vector<std::string> rest(words.begin(), at(from));
    rest.insert(rest.end(), at(to), words.end());
    while (!rest.empty() && rest.front() == kComma)
      rest.erase(rest.begin());
    if (meanings.size() == 1 && !rest.empty())
      found.emplace_back(meanings.front(), std::move(rest));
  };
  for (std::size_t i = 1; i < words.size(); ++i) {
    note(0, i);
    note(i, words.size());
  }
  for (std::size_t i = 1; use == Use::during && i + 1 < words.size(); ++i)
    for (std::size_t end = i + 1; end < words.size(); ++end)
      note(i, end);  // "go slowly to the lobby"
  return found;
}

std::vector<Meaning> Grammar::Finder::steps_in(std::vector<std::string>& sentence,
                                               const std::vector<std::string>& before) {
  sentence = without_commas(std::move(sentence));
  if (sentence.empty())
    return {};
  std::vector<Meaning> meanings;
  if (!before.empty())
    meanings = look(sentence, true, false, Use::later);
  if (meanings.empty())
    meanings = look(sentence, true, false, Use::command);
  const auto one_step = [&] { return meanings.size() == 1 && grammar_.is_step(meanings.front()); };
  if (auto all = grammar_.completed(before, sentence);
      !all.empty() && (!one_step() || sentence.size() == 1)) {
    std::vector<Meaning> again = look(all, true, false, Use::command);
    if (!one_step() || !again.empty()) {
      if (again.size() == 1 && grammar_.takes_text(again.front().functor))
        return {};
      meanings = std::move(again);
      sentence = std::move(all);
    }
  }
  if (one_step())
    return meanings;
  if (meanings.empty())
    for (auto& [often, rest] : asides(sentence, Use::times))
      if (meanings = steps_in(rest, before); meanings.size() == 1) {
        const auto times = static_cast<std::size_t>(std::min(number_of(often, "count"), 99.0));
        sentence = std::move(rest);
        return std::vector<Meaning>(times, meanings.front());
      }
  return {};
}

std::vector<std::vector<Meaning>> Grammar::Finder::divided(const std::vector<std::string>& words,
                                                           const std::vector<std::string>& before,
                                                           bool runs_on) {
  std::vector<std::vector<Meaning>> ways;
  const bool first = before.empty();
  std::vector<std::string> all = words;
  if (std::vector<Meaning> last = steps_in(all, before);
      last.size() > (first ? 1U : 0U) && last.size() <= kMostSteps)
    ways.push_back(std::move(last));
  for (std::size_t i = 1; i + 1 < words.size(); ++i) {
    const std::size_t between = grammar_.joint(words, i);
    if (i + between >= words.size() || grammar_.joint(words, i - 1) > 1)
      continue;
    if (between == 0 &&
        (!runs_on || i < 2 || i + 2 > words.size() || words[i] == "to" || words[i] == "the"))
      continue;
    const auto at = words.begin() + static_cast<std::ptrdiff_t>(i);
    std::vector<std::string> sentence(words.begin(), at);
    const std::vector<Meaning> head = steps_in(sentence, before);
    if (head.empty())
      continue;
    const auto next = at + static_cast<std::ptrdiff_t>(between);
    for (std::vector<Meaning>& rest : divided({next, words.end()}, sentence, runs_on)) {
      rest.insert(rest.begin(), head.begin(), head.end());
      if (rest.size() <= kMostSteps)
        ways.push_back(std::move(rest));
    }
  }
  return ways;
}

}  // namespace saphira::agent_interface
