#include "saphira/intentions/schema.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::intentions {
namespace {

/// Farther away than any robot goes [m]: a point beyond it is a mistake, such as millimeters.
constexpr double kFarthest = 10e3;

std::string expected(const Parameter& parameter) {
  const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
  switch (parameter.kind) {
    case ArgumentKind::kNumber:
      return "a number from " + plain(parameter.low) + " to " + plain(parameter.high) + unit;
    case ArgumentKind::kText:
      return "a text";
    case ArgumentKind::kPoint:
      return "a point, within " + plain(kFarthest) + " m";
  }
  return "?";
}

std::string came(const Argument& argument) {
  switch (argument.kind) {
    case ArgumentKind::kNumber:
      return plain(argument.number);
    case ArgumentKind::kText:
      return "the text " + quoted(argument.text);
    case ArgumentKind::kPoint: {
      const char* const frame = argument.frame == Frame::kRobot  ? "robot"
                                : argument.frame == Frame::kOdom ? "odom"
                                                                 : "map";
      return "the point (" + plain(argument.point.x) + ", " + plain(argument.point.y) + ") in " +
             frame;
    }
  }
  return "?";
}

bool fits(const Parameter& parameter, const Argument& argument) {
  if (argument.kind != parameter.kind)
    return false;
  switch (parameter.kind) {
    case ArgumentKind::kNumber:  // false for NaN
      return argument.number >= parameter.low && argument.number <= parameter.high;
    case ArgumentKind::kText:
      return true;
    case ArgumentKind::kPoint:
      return std::isfinite(argument.point.th) && std::abs(argument.point.x) <= kFarthest &&
             std::abs(argument.point.y) <= kFarthest;
  }
  return false;
}

std::string names_of(const std::vector<Parameter>& parameters) {
  std::string names;
  for (const Parameter& parameter : parameters)
    names += (names.empty() ? "" : ", ") + parameter.name;
  return names.empty() ? "no arguments" : names;
}

}  // namespace

void Registry::add(Schema schema) {
  std::string name = schema.name;
  schemas_.insert_or_assign(std::move(name), std::move(schema));
}

const Schema* Registry::find(std::string_view name) const {
  const auto found = schemas_.find(name);
  return found == schemas_.end() ? nullptr : &found->second;
}

std::string Registry::names() const {
  std::string names;
  for (const auto& [name, schema] : schemas_)
    names += (names.empty() ? "" : ", ") + name;
  return names;
}

std::string check_arguments(const Schema& schema, const Arguments& arguments, Arguments& complete) {
  complete.clear();
  for (auto argument = arguments.begin(); argument != arguments.end(); ++argument) {
    const auto parameter =
        std::find_if(schema.parameters.begin(), schema.parameters.end(),
                     [&](const Parameter& known) { return known.name == argument->name; });
    if (parameter == schema.parameters.end())
      return schema.name + " has no argument " + quoted(argument->name) + ": it takes " +
             names_of(schema.parameters);
    if (intentions::find(complete, argument->name) != nullptr)
      return "argument " + quoted(argument->name) + " is given twice";
    if (!fits(*parameter, *argument))
      return "argument " + quoted(argument->name) + ": expected " + expected(*parameter) +
             ", got " + came(*argument);
    complete.push_back(*argument);
  }
  for (const Parameter& parameter : schema.parameters) {
    if (intentions::find(complete, parameter.name) != nullptr)
      continue;
    if (parameter.required)
      return schema.name + " needs the argument " + quoted(parameter.name) + ": expected " +
             expected(parameter) + ", got none";
    if (parameter.usual)
      complete.push_back(number(parameter.name, *parameter.usual));
  }
  return schema.check ? schema.check(complete) : std::string();
}

}  // namespace saphira::intentions
