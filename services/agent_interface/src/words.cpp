#include "words.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace saphira::agent_interface {

std::string slot(const Meaning& meaning, const std::string& name) {
  const auto found = meaning.slots.find(name);
  return found == meaning.slots.end() ? std::string() : found->second;
}

double number_of(const Meaning& meaning, const std::string& name) {
  return std::strtod(slot(meaning, name).c_str(), nullptr);
}

Meaning with(Meaning meaning, const std::string& name, const std::string& value) {
  meaning.slots[name] = value;
  return meaning;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string speaker_of(const Advice& advice) {
  return advice.speaker.empty() ? "somebody" : advice.speaker;
}

std::string speaker_of(const Utterance& utterance) {
  return utterance.speaker.empty() ? "somebody" : utterance.speaker;
}

std::string as_told(const Advice& advice) {
  return advice.speaker == kRobot ? "I found " + advice.about + " at " + advice.value
                                  : speaker_of(advice) + " said that " + describe(advice);
}

std::string claim_source(const Utterance& utterance) {
  return speaker_of(utterance) + " said \"" + utterance.text + "\"";
}

bool is_open(const KnownGoal& goal) {
  return goal.state != KnownGoal::State::failed && goal.state != KnownGoal::State::over;
}

std::string field(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

std::vector<std::string> fields(std::string_view line) {
  std::vector<std::string> result(1);
  for (const char c : line) {
    if (c == '\t')
      result.emplace_back();
    else
      result.back() += c;
  }
  return result;
}

}  // namespace saphira::agent_interface
