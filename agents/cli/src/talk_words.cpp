#include "saphira/cli/talk_words.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "requests/shell/convert.hpp"
#include "saphira/base/enumerators.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"
#include "saphira/cli/goal_words.hpp"
#include "saphira/cli/words.hpp"

namespace saphira::cli {
namespace {

/// For programs, such as bad_argument.
std::string name_of(v1::AnswerCode code) {
  constexpr auto& kNames = kEnumeratorNames<v1::AnswerCode>;
  const auto at = static_cast<std::size_t>(code);
  return at < kNames.size() ? lowered(kNames[at].substr(std::string_view("ANSWER_").size())) : "?";
}
/// For people; empty where the text says it.
const char* words_of(v1::AnswerCode code) {
  return word_of(code, {"", "", "", "refused", "not known", "bad argument", "nobody can",
                        "too late", "given up", "lost"});
}

nlohmann::ordered_json value_of(const v1::Argument& argument) {
  switch (argument.kind) {
    case v1::ARGUMENT_NUMBER:
      return argument.number;
    case v1::ARGUMENT_TEXT:
      return argument.text;
    case v1::ARGUMENT_TRUTH:
      return argument.number != 0.0;
    case v1::ARGUMENT_POINT:
      return {{"x", argument.point.x},
              {"y", argument.point.y},
              {"th", argument.point.th},
              {"frame", situation::name_of(argument.frame)}};
    case v1::ARGUMENT_UNBOUND:
      break;
  }
  return nullptr;
}

/// The local time of day, such as 10:02.
std::string time_of(double time) {
  return time <= 0.0 ? "-" : local_text(static_cast<std::int64_t>(time), "%a %H:%M");
}

v1::Argument text_argument(const std::string& name, const std::string& text) {
  return {.name = name, .kind = v1::ARGUMENT_TEXT, .text = text};
}

/// Such as note(door="3"); without arguments the functor alone.
std::string call_of(const std::string& functor, const std::vector<v1::Argument>& arguments) {
  if (arguments.empty())
    return functor;
  return functor + "(" +
         joined(from_bus(arguments), ", ",
                [](const Argument& one) { return saphira::describe(Arguments{one}); }) +
         ")";
}

std::string describe(const v1::Agent& agent) {
  std::string text = agent.name + "  " + agent.summary + "\n";
  for (const v1::Capability& capability : agent.capabilities) {
    std::string arguments;
    for (const v1::CapabilityParameter& parameter : capability.parameters)
      arguments += (arguments.empty() ? "" : ", ") +
                   (parameter.required ? parameter.name : "[" + parameter.name + "]");
    text += "  " + capability.functor + "(" + arguments + ")  " + capability.summary + "\n";
    for (const v1::CapabilityParameter& parameter : capability.parameters) {
      // An unbound one may be of any kind.
      std::string words =
          parameter.kind == v1::ARGUMENT_UNBOUND ? "" : saphira::describe(from_bus(parameter.kind));
      if (parameter.low < parameter.high)
        words += ", " + plain(parameter.low) + " to " + plain(parameter.high);
      if (!parameter.choices.empty())
        words += ", one of " + joined(parameter.choices);
      if (!parameter.meaning.empty())
        words += (words.empty() ? "" : ", ") + parameter.meaning;
      if (!words.empty())
        text += "    " + parameter.name + ": " + words + "\n";
    }
  }
  return text;
}

}  // namespace

v1::Argument parse_slot(const std::string& word) {
  const std::size_t open = word.find("=?");
  if (open == std::string::npos || open == 0 || open != word.find('='))
    return parse_argument(word);
  v1::Argument argument{
      .name = word.substr(0, open), .kind = v1::ARGUMENT_UNBOUND, .text = word.substr(open + 2)};
  const std::string& variable = argument.text;
  if (!std::ranges::all_of(
          variable, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; }))
    throw std::invalid_argument("expected name=? or name=?VARIABLE, found \"" + word + "\"");
  return argument;
}

v1::Request parse_question(const std::vector<std::string>& words) {
  v1::Request request;
  if (words.at(0).find('(') == std::string::npos) {
    request.functor = words[0];
    for (std::size_t i = 1; i < words.size(); ++i)
      request.arguments.push_back(parse_slot(words[i]));
    return request;
  }
  for (const std::string& word : words) {
    const std::size_t begin = word.find('(');
    if (begin == std::string::npos || begin == 0 || !word.ends_with(')'))
      throw std::invalid_argument("expected FUNCTOR(name=value, ...), found \"" + word + "\"");
    const std::string functor = word.substr(0, begin);
    if (&word == &words.front())
      request.functor = functor;
    else
      request.arguments.push_back(text_argument("and", functor));
    std::vector<std::string> slots;
    std::istringstream inside(word.substr(begin + 1, word.size() - begin - 2));
    for (std::string piece; std::getline(inside, piece, ',');)
      if (slots.empty() || piece.find('=') != std::string::npos)
        slots.push_back(piece.substr(std::min(piece.find_first_not_of(' '), piece.size())));
      else
        slots.back() += "," + piece;  // a value may have commas, as a point has
    for (const std::string& slot : slots)
      request.arguments.push_back(parse_slot(slot));
  }
  return request;
}

bool is_for(const v1::Utterance& utterance, double age, std::uint64_t instance, double listened) {
  return utterance.answers.writer == instance || age <= listened;
}

std::string line_of(const v1::Utterance& utterance, const std::string& robot) {
  const std::string speaker = robot.empty() ? utterance.speaker : robot;
  return (speaker.empty() ? "somebody" : speaker) + ": " + utterance.text;
}

std::string line_of(const v1::Answer& answer) {
  const std::string code = words_of(answer.code);
  std::string line = answer.service + ":";
  if (!code.empty())
    line += " " + code + (answer.text.empty() ? "" : ":");
  if (!answer.text.empty())
    line += " " + answer.text;
  if (!answer.results.empty())
    line += " " + saphira::describe(from_bus(answer.results));
  return line == answer.service + ":" ? line + " done" : line;
}

bool repeats(const v1::Answer& answer, const v1::Answer& before) {
  return answer.results.empty() && answer == before;
}

std::string to_json(const v1::Answer& answer, const std::string& robot) {
  nlohmann::ordered_json json{{"agent", answer.service},
                              {"code", name_of(answer.code)},
                              {"text", answer.text},
                              {"values", nlohmann::ordered_json::object()}};
  if (!robot.empty())
    json["robot"] = robot;
  std::map<std::string, int> count;
  for (const v1::Argument& result : answer.results) {
    nlohmann::ordered_json& value = json["values"][result.name];
    const int before = count[result.name]++;
    if (before == 1)
      value = nlohmann::ordered_json::array({value});
    if (before == 0)
      value = value_of(result);
    else
      value.push_back(value_of(result));
  }
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string describe(const std::vector<v1::Agent>& agents) {
  std::string text;
  std::string robot;
  for (const v1::Agent& agent : agents)
    if (agent.name == "robot")
      robot += "robot  " + std::to_string(agent.capabilities.size()) +
               " activities: saphira goal activities lists them\n";
    else
      text += describe(agent);
  return text + robot;
}

bool is_among(const std::string& id, const std::string& ids) {
  return (" " + ids + " ").find(" " + id + " ") != std::string::npos;
}

std::string describe(const v1::Trigger& trigger, const std::string& id, bool live,
                     const std::string& missing) {
  const std::string condition = call_of(trigger.condition, trigger.condition_arguments);
  std::string when = "every " + plain(trigger.period) + " s";
  if (trigger.kind == v1::TRIGGER_DATA)
    when = "when the answer to " + condition + " changes";
  else if (trigger.kind == v1::TRIGGER_EVENT)
    when = "when " + condition + " happens";
  return "trigger " + id + " of " + (trigger.source.empty() ? "somebody" : trigger.source) + ": " +
         when + ": " + call_of(trigger.action, trigger.action_arguments) +
         (live ? (missing.empty() ? "" : "; waits: ") + missing
               : "; it fires no more: it has fired its times, was withdrawn, or its period is "
                 "below 0.1 s");
}

std::string knowledge_table(const v1::Knowledge& knowledge) {
  if (knowledge.known.empty())
    return "the robot was told nothing that it knows now\n";
  std::vector<std::vector<std::string>> rows{{"number", "what", "said by", "when", "in the words"}};
  for (const v1::Advice& advice : knowledge.known)
    rows.push_back({std::to_string(advice.number), advice.words,
                    advice.speaker.empty() ? "somebody" : advice.speaker, time_of(advice.time),
                    advice.said});
  return table(rows);
}

}  // namespace saphira::cli
