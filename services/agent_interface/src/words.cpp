#include "words.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>

#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"

namespace saphira::agent_interface {
namespace {

constexpr std::array kOnes{"zero",    "one",     "two",       "three",    "four",
                           "five",    "six",     "seven",     "eight",    "nine",
                           "ten",     "eleven",  "twelve",    "thirteen", "fourteen",
                           "fifteen", "sixteen", "seventeen", "eighteen", "nineteen"};
constexpr std::array kTens{"twenty", "thirty",  "forty",  "fifty",
                           "sixty",  "seventy", "eighty", "ninety"};

/// Of "zero" to "nineteen"; otherwise -1.
int one_of(std::string_view word) {
  const auto found = std::ranges::find(kOnes, word);
  return found == kOnes.end() ? -1 : static_cast<int>(found - kOnes.begin());
}

/// Of "twenty" to "ninety-nine", in one word; otherwise -1.
int ten_of(std::string_view word) {
  const std::size_t hyphen = std::min(word.find('-'), word.size());
  const auto found = std::ranges::find(kTens, word.substr(0, hyphen));
  const int one = hyphen == word.size() ? 0 : one_of(word.substr(hyphen + 1));
  return found == kTens.end() || one < 0 || one > 9
             ? -1
             : 20 + 10 * static_cast<int>(found - kTens.begin()) + one;
}

}  // namespace

std::pair<int, std::size_t> spoken_number(const std::vector<std::string>& words, std::size_t at) {
  const auto word = [&](std::size_t i) -> std::string_view {
    return i < words.size() ? std::string_view(words[i]) : std::string_view();
  };
  std::pair<int, std::size_t> number{0, 0};
  const int hundreds = word(at) == "a" ? 1 : one_of(word(at));
  if (hundreds > 0 && hundreds < 10 && word(at + 1) == "hundred")
    number = {100 * hundreds, 2};
  const std::size_t more = number.second + (number.second > 0 && word(at + 2) == "and" ? 1 : 0);
  const int ten = ten_of(word(at + more));
  const int one = one_of(word(at + more + (ten > 0 ? 1 : 0)));
  if (ten > 0 && ten % 10 == 0 && one > 0 && one < 10)
    return {number.first + ten + one, more + 2};
  if (ten > 0 || (one >= 0 && (one > 0 || more == 0)))
    return {number.first + (ten > 0 ? ten : one), more + 1};
  return number;
}

std::string in_digits(const std::string& name) {
  const std::vector<std::string> said = words_of(name);
  std::vector<std::string> words;
  bool counts = false;  // the word before is a number
  for (std::size_t at = 0; at < said.size();) {
    const auto [number, count] = spoken_number(said, at);
    const std::string digits = count > 0             ? std::to_string(number)
                               : is_number(said[at]) ? said[at]
                                                     : "";
    if (counts && !digits.empty())
      words.back() += digits;
    else
      words.push_back(digits.empty() ? said[at] : digits);
    counts = !digits.empty();
    at += std::max<std::size_t>(count, 1);
  }
  return saphira::joined(words, " ");
}

std::string slot(const Meaning& meaning, const std::string& name) {
  const auto found = meaning.slots.find(name);
  return found == meaning.slots.end() ? std::string() : found->second;
}

Argument open_slot(std::string name) {
  Argument slot;
  slot.name = std::move(name);
  slot.kind = ArgumentKind::unbound;
  return slot;
}

double number_of(const Meaning& meaning, const std::string& name) {
  return std::strtod(slot(meaning, name).c_str(), nullptr);
}

bool is_yes_or_no(const Meaning& meaning) {
  return meaning.functor == "yes" || meaning.functor == "no";
}

bool is_question(std::string_view text) {
  const std::size_t last = text.find_last_not_of(" \t\"'.!");
  return last != std::string_view::npos && text[last] == '?';
}

Meaning with(Meaning meaning, const std::string& name, const std::string& value) {
  meaning.slots[name] = value;
  return meaning;
}

std::string named_person(const std::string& name) {
  return name.empty() ? "somebody" : name;
}

const std::string& words_said(const Utterance& utterance) {
  return utterance.corrects.empty() ? utterance.text : utterance.corrects;
}

std::string named_task(const Task& task, const std::string& listener) {
  return (task.name.empty() ? "that" : task.name) +
         (same_person(task.goal.speaker, listener) ? ""
                                                   : " for " + named_person(task.goal.speaker));
}

std::string time_text(double unix_time) {
  const auto seconds = static_cast<std::int64_t>(unix_time);
  return seconds > 0 ? local_text(seconds, "at %H:%M ") : std::string();
}

bool is_aboard(const std::string& thing, const Situation& situation) {
  return std::any_of(situation.carried.begin(), situation.carried.end(),
                     [&](const auto& one) { return one.first == thing; });
}

bool is_handover(std::string_view asked_about) {
  return asked_about == "given" || asked_about == "taken";
}

bool same_person(const std::string& a, const std::string& b) {
  return lowered(a) == lowered(b);
}

bool may_answer(const Utterance& utterance, const Utterance& raised_by) {
  constexpr double kPatience = 20.0;  // [s]
  return same_person(utterance.speaker, raised_by.speaker) &&
         (utterance.time <= 0.0 || raised_by.time <= 0.0 ||
          utterance.time - raised_by.time <= kPatience);
}

std::string as_told(const Advice& advice) {
  return advice.speaker == kRobot ? "I found " + advice.about + " at " + advice.value
                                  : named_person(advice.speaker) + " said that " + describe(advice);
}

std::string source_of(const Advice& advice) {
  return advice.speaker == kRobot
             ? kRobot + (" found " + advice.about) + " " + time_text(advice.time) + "there"
             : named_person(advice.speaker) + " said " + time_text(advice.time) + "\"" +
                   advice.said + "\"";
}

std::string claim_source(const Utterance& utterance) {
  return named_person(utterance.speaker) + " said \"" + words_said(utterance) + "\"";
}

}  // namespace saphira::agent_interface
