#include "saphira/requests/functor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "saphira/base/enumerators.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"

namespace saphira {
namespace {

const char* word(Frame frame) {
  return word_of(frame, {"the robot's frame", "odom", "the map"});
}

/// The bound of a number, for people.
std::string bound(const Parameter& parameter, double value) {
  return parameter.whole ? std::to_string(static_cast<long long>(value)) : plain(value);
}

std::string expected(const Parameter& parameter) {
  std::string words =
      parameter.kind == ArgumentKind::unbound ? "a value" : describe(parameter.kind);
  if (parameter.kind == ArgumentKind::number)
    words = (parameter.whole ? "a whole number from " : "a number from ") +
            bound(parameter, parameter.low) + " to " + bound(parameter, parameter.high);
  if (parameter.kind == ArgumentKind::point)
    words += std::string(" in ") + word(parameter.frame);
  if (!parameter.choices.empty()) {
    words.clear();
    for (const std::string& choice : parameter.choices)
      words += (words.empty() ? "" : &choice == &parameter.choices.back() ? " or " : ", ") + choice;
  }
  return words + " (" + parameter.meaning + ")";
}

bool is_finite(const Pose& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.th);
}

bool fits(const Parameter& parameter, const Argument& argument) {
  if (parameter.kind == ArgumentKind::unbound)
    return true;
  if (argument.kind != parameter.kind)
    return false;
  switch (argument.kind) {
    case ArgumentKind::number:  // written so that NaN does not fit
      return argument.number >= parameter.low && argument.number <= parameter.high &&
             (!parameter.whole || argument.number == std::floor(argument.number));
    case ArgumentKind::text:
      return parameter.choices.empty() ||
             std::find(parameter.choices.begin(), parameter.choices.end(), argument.text) !=
                 parameter.choices.end();
    case ArgumentKind::point:
      return argument.frame == parameter.frame && is_finite(argument.point);
    case ArgumentKind::truth:
      return argument.number == 0.0 || argument.number == 1.0;
    case ArgumentKind::unbound:
      break;
  }
  return true;
}

std::string found(const Argument& argument) {
  const std::string all = describe(Arguments{argument});
  std::string value = all.substr(all.find('=') + 1);
  if (argument.kind == ArgumentKind::point)
    value += std::string(" in ") + word(argument.frame);
  return value;
}

std::string takes(const Functor& functor) {
  const std::string names = joined(functor.parameters, ", ", &Parameter::name);
  return names.empty() ? "no arguments" : names;
}

}  // namespace

Parameter number_parameter(std::string name, std::string meaning, double low, double high) {
  return {std::move(name), ArgumentKind::number, std::move(meaning), true, low, high};
}

Parameter whole_parameter(std::string name, std::string meaning, double low, double high) {
  Parameter parameter = number_parameter(std::move(name), std::move(meaning), low, high);
  parameter.whole = true;
  return parameter;
}

Parameter text_parameter(std::string name, std::string meaning, std::vector<std::string> choices) {
  Parameter parameter{std::move(name), ArgumentKind::text, std::move(meaning)};
  parameter.choices = std::move(choices);
  return parameter;
}

Parameter point_parameter(std::string name, std::string meaning, Frame frame) {
  Parameter parameter{std::move(name), ArgumentKind::point, std::move(meaning)};
  parameter.frame = frame;
  return parameter;
}

Parameter truth_parameter(std::string name, std::string meaning) {
  return {std::move(name), ArgumentKind::truth, std::move(meaning)};
}

Parameter optional(Parameter parameter, double usual) {
  parameter.required = false;
  parameter.usual = usual;
  return parameter;
}

Parameter list(Parameter parameter) {
  parameter.required = false;
  parameter.list = true;
  return parameter;
}

std::string complete(const Functor& functor, Arguments& arguments) {
  for (const Argument& argument : arguments) {
    const auto parameter =
        std::find_if(functor.parameters.begin(), functor.parameters.end(),
                     [&](const Parameter& p) { return p.name == argument.name; });
    const std::string where = functor.name + ": argument " + quoted(argument.name);
    if (parameter == functor.parameters.end())
      return where + " is not known: expected " + takes(functor);
    if (!parameter->list && find(arguments, argument.name) != &argument)
      return where + " is given twice";
    if (!fits(*parameter, argument))
      return where + ": expected " + expected(*parameter) + ", found " + found(argument);
  }
  for (const Parameter& parameter : functor.parameters) {
    if (find(arguments, parameter.name) != nullptr)
      continue;
    if (parameter.required)
      return functor.name + ": argument " + quoted(parameter.name) + " is missing: expected " +
             expected(parameter);
    if (parameter.list)
      continue;
    if (parameter.kind == ArgumentKind::number)
      arguments.push_back(number(parameter.name, parameter.usual));
    else if (parameter.kind == ArgumentKind::truth)
      arguments.push_back(truth(parameter.name, parameter.usual != 0.0));
  }
  return {};
}

std::string help(const std::vector<Functor>& functors) {
  std::string text;
  for (const Functor& functor : functors) {
    text += functor.name + "(";
    for (const Parameter& parameter : functor.parameters) {
      const std::string name = parameter.name + (parameter.list ? " ..." : "");
      text += (&parameter == &functor.parameters.front() ? "" : ", ") +
              (parameter.required ? name : "[" + name + "]");
    }
    text += "): " + functor.summary + "\n";
    for (const Parameter& parameter : functor.parameters)
      text += "  " + parameter.name + ": " + expected(parameter) + "\n";
  }
  return text;
}

}  // namespace saphira
