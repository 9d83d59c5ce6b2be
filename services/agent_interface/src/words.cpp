#include "words.hpp"

#include <algorithm>
#include <cstdlib>
#include <ctime>

#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"

namespace saphira::agent_interface {
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
