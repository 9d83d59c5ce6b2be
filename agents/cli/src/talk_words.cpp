#include "saphira/cli/talk_words.hpp"

#include <array>
#include <ctime>

#include "requests/shell/convert.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/cli/goal_words.hpp"
#include "saphira/cli/words.hpp"

namespace saphira::cli {
namespace {

const char* word(v1::AnswerCode code) {
  switch (code) {
    case v1::ANSWER_UNDERWAY:
    case v1::ANSWER_DONE:
    case v1::ANSWER_SENT:
      return "";
    case v1::ANSWER_REFUSED:
      return "refused";
    case v1::ANSWER_UNKNOWN_FUNCTOR:
      return "not known";
    case v1::ANSWER_BAD_ARGUMENT:
      return "bad argument";
    case v1::ANSWER_NOBODY:
      return "nobody can";
    case v1::ANSWER_TOO_LATE:
      return "too late";
    case v1::ANSWER_GIVEN_UP:
      return "given up";
    case v1::ANSWER_LOST:
      return "lost";
  }
  return "?";
}

/// The local time of day, such as 10:02.
std::string time_of(double time) {
  if (time <= 0.0)
    return "-";
  const auto seconds = static_cast<std::time_t>(time);
  std::tm local{};
  localtime_r(&seconds, &local);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%a %H:%M", &local);
  return text.data();
}

}  // namespace

v1::Argument parse_slot(const std::string& word) {
  if (word.size() > 2 && word.ends_with("=?")) {
    v1::Argument argument;
    argument.name(word.substr(0, word.size() - 2));
    argument.kind(v1::ARGUMENT_UNBOUND);
    return argument;
  }
  return parse_argument(word);
}

std::string line_of(const v1::Utterance& utterance, const std::string& robot) {
  const std::string speaker = robot.empty() ? utterance.speaker() : robot;
  return (speaker.empty() ? "somebody" : speaker) + ": " + utterance.text();
}

std::string line_of(const v1::Answer& answer) {
  const std::string code = word(answer.code());
  std::string line = answer.service() + ":";
  if (!code.empty())
    line += " " + code + (answer.text().empty() ? "" : ":");
  if (!answer.text().empty())
    line += " " + answer.text();
  if (!answer.results().empty())
    line += " " + saphira::describe(from_bus(answer.results()));
  return line == answer.service() + ":" ? line + " done" : line;
}

std::string describe(const v1::Agent& agent) {
  std::string text = agent.name() + "  " + agent.summary() + "\n";
  for (const v1::Capability& capability : agent.capabilities()) {
    std::string arguments;
    for (const v1::CapabilityParameter& parameter : capability.parameters())
      arguments += (arguments.empty() ? "" : ", ") +
                   (parameter.required() ? parameter.name() : "[" + parameter.name() + "]");
    text += "  " + capability.functor() + "(" + arguments + ")  " + capability.summary() + "\n";
    for (const v1::CapabilityParameter& parameter : capability.parameters())
      text += "    " + parameter.name() + ": " + saphira::describe(from_bus(parameter.kind())) +
              (parameter.meaning().empty() ? "" : ", " + parameter.meaning()) + "\n";
  }
  return text;
}

std::string describe(const v1::Trigger& trigger) {
  std::string when = "every " + plain(trigger.period()) + " s";
  if (trigger.kind() == v1::TRIGGER_DATA)
    when = "when the answer to " + trigger.condition() + " changes";
  else if (trigger.kind() == v1::TRIGGER_EVENT)
    when = "when " + trigger.condition() + " happens";
  return "trigger of " + trigger.source() + ": " + when + ": " + trigger.action();
}

std::string knowledge_table(const v1::Knowledge& knowledge) {
  if (knowledge.known().empty())
    return "the robot was told nothing that it knows now\n";
  std::vector<std::vector<std::string>> rows{{"number", "what", "said by", "when", "in the words"}};
  for (const v1::Advice& advice : knowledge.known())
    rows.push_back({std::to_string(advice.number()), advice.words(),
                    advice.speaker().empty() ? "somebody" : advice.speaker(),
                    time_of(advice.time()), advice.said()});
  return table(rows);
}

}  // namespace saphira::cli
