#include "saphira/intentions/schema.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/base/guess.hpp"
#include "saphira/base/text.hpp"
#include "saphira/base/units.hpp"
#include "saphira/intentions/functions.hpp"

namespace saphira::intentions {
namespace {

/// Beyond the range of any robot [m]: a farther point is an error, such as millimeters.
constexpr double kFarthest = 10e3;
constexpr double kMostTurns = 1e3;  ///< [rad] of an accumulated heading

/// Without hyphens: the same for follow-corridor and FollowCorridor.
std::string without_hyphens(std::string_view name) {
  std::string result = normal(name);
  std::erase(result, '-');
  return result;
}

std::string expected(const Parameter& parameter) {
  if (parameter.any)
    return "a number, a text or a point, within " + plain(kFarthest) + " m and " +
           plain(kMostTurns) + " rad";
  const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
  switch (parameter.kind) {
    case ArgumentKind::number:
      return "a number from " + plain(parameter.low) + " to " + plain(parameter.high) + unit;
    case ArgumentKind::text:
      return parameter.place ? "the name of a place, or a point x,y@map" : "a text";
    case ArgumentKind::point:
      return "a point x,y or x,y,heading, such as 3,1, within " + plain(kFarthest) + " m";
    case ArgumentKind::truth:
    case ArgumentKind::unbound:
      break;
  }
  return describe(parameter.kind);
}

std::string came(const Argument& argument) {
  switch (argument.kind) {
    case ArgumentKind::number:
      return plain(argument.number);
    case ArgumentKind::text:
      return "the text " + quoted(argument.text);
    case ArgumentKind::point: {
      const char* const frame = argument.frame == Frame::robot  ? "robot"
                                : argument.frame == Frame::odom ? "odom"
                                                                : "map";
      return "the point (" + plain(argument.point.x) + ", " + plain(argument.point.y) + ", " +
             plain(argument.point.th) + ") in " + frame;
    }
    case ArgumentKind::truth:
    case ArgumentKind::unbound:
      break;
  }
  return describe(argument.kind);
}

/// False for NaN, as all comparisons here.
bool fits(const Parameter& parameter, const Argument& argument) {
  const bool instead = parameter.place && argument.kind == ArgumentKind::point;
  if (!parameter.any && !instead && argument.kind != parameter.kind)
    return false;
  switch (argument.kind) {
    case ArgumentKind::number:
      return parameter.any ? std::isfinite(argument.number)
                           : argument.number >= parameter.low && argument.number <= parameter.high;
    case ArgumentKind::text:
      return true;
    case ArgumentKind::point:
      return std::abs(argument.point.x) <= kFarthest && std::abs(argument.point.y) <= kFarthest &&
             std::abs(argument.point.th) <= kMostTurns;
    case ArgumentKind::truth:
    case ArgumentKind::unbound:
      break;
  }
  return false;
}

std::string names_of(const std::vector<Parameter>& parameters) {
  const std::string names = saphira::joined(parameters, ", ", &Parameter::name);
  return names.empty() ? "no arguments" : names;
}

}  // namespace

void Registry::add(Schema schema) {
  std::string name = normal(schema.name);
  schemas_.insert_or_assign(std::move(name), std::make_shared<const Schema>(std::move(schema)));
}

void Registry::remove(std::string_view name) {
  schemas_.erase(normal(name));
}

const Schema* Registry::find(std::string_view name) const {
  const auto found = schemas_.find(normal(name));
  return found == schemas_.end() ? nullptr : found->second.get();
}

std::shared_ptr<const Schema> Registry::share(std::string_view name) const {
  const auto found = schemas_.find(normal(name));
  return found == schemas_.end() ? nullptr : found->second;
}

std::shared_ptr<const Schema> Registry::intended(std::string_view name) const {
  const std::shared_ptr<const Schema> schema = share(name);
  const bool capital = !name.empty() && name.front() >= 'A' && name.front() <= 'Z';
  return schema && capital && schema->name != name ? nullptr : schema;
}

std::vector<const Schema*> Registry::all() const {
  std::vector<const Schema*> all;
  for (const auto& [name, schema] : schemas_)
    all.push_back(schema.get());
  return all;
}

std::string Registry::instead_of(std::string_view functor) const {
  std::vector<std::string> names;
  for (const auto& [name, schema] : schemas_)
    names.push_back(schema->name);
  const std::string meant = guess(functor, names);
  return (meant.empty() ? "" : "did you mean " + meant + "? ") +
         "saphira goal activities lists the " + std::to_string(names.size()) + " that there are";
}

void Registry::know_behaviors(std::vector<BehaviorSignature> behaviors) {
  behaviors_.clear();
  for (BehaviorSignature& behavior : behaviors) {
    std::string name = without_hyphens(behavior.name);
    behaviors_.insert_or_assign(std::move(name), std::move(behavior));
  }
  knows_behaviors_ = true;
}

const BehaviorSignature* Registry::behavior(std::string_view name) const {
  const auto found = behaviors_.find(without_hyphens(name));
  return found == behaviors_.end() ? nullptr : &found->second;
}

std::string Registry::behavior_name(std::string_view name) const {
  if (const BehaviorSignature* const known = behavior(name))
    return known->name;
  std::string result;
  bool capital = true;
  for (const char c : name) {
    if (c == '-' || c == '_') {
      capital = true;
      continue;
    }
    result += capital && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    capital = false;
  }
  return result;
}

std::string check_arguments(const Schema& schema, const Arguments& arguments, Arguments& complete) {
  complete.clear();
  for (auto argument = arguments.begin(); argument != arguments.end(); ++argument) {
    const auto parameter = std::find_if(
        schema.parameters.begin(), schema.parameters.end(), [&](const Parameter& known) {
          return known.name == argument->name || normal(known.name) == normal(argument->name);
        });
    if (parameter == schema.parameters.end())
      return schema.name + " has no argument " + quoted(argument->name) + ": it takes " +
             names_of(schema.parameters);
    if (saphira::find(complete, parameter->name) != nullptr)
      return "argument " + quoted(argument->name) + " is given twice";
    Argument taken = *argument;
    taken.name = parameter->name;
    // A number in place of a text is a name.
    if (!parameter->any && parameter->kind == ArgumentKind::text &&
        taken.kind == ArgumentKind::number)
      taken = text(parameter->name, plain(taken.number));
    // A number with its unit is a text on the bus.
    if (!parameter->any && parameter->kind == ArgumentKind::number &&
        taken.kind == ArgumentKind::text && !parameter->unit.empty())
      if (const auto value = measured(taken.text, parameter->unit))
        taken = number(parameter->name, *value);
    if (!fits(*parameter, taken))
      return "argument " + quoted(argument->name) + ": expected " + expected(*parameter) +
             ", got " + came(*argument);
    complete.push_back(std::move(taken));
  }
  for (const Parameter& parameter : schema.parameters) {
    if (saphira::find(complete, parameter.name) != nullptr)
      continue;
    if (parameter.required)
      return schema.name + " needs the argument " + quoted(parameter.name) + ": expected " +
             expected(parameter) + ", got none";
    if (parameter.usual)
      complete.push_back(number(parameter.name, *parameter.usual));
    else if (parameter.usual_text)
      complete.push_back(text(parameter.name, *parameter.usual_text));
  }
  return schema.check ? schema.check(complete) : std::string();
}

Bindings fixed_in_odom(const Bindings& bindings, const Robot& robot) {
  Bindings fixed = bindings;
  for (auto& [name, value] : fixed) {
    const Point* const point = value.point();
    if (point != nullptr && point->frame == Frame::robot)
      value = Value(Point{compose(robot.pose_in_odom, point->pose), Frame::odom});
  }
  return fixed;
}

std::unique_ptr<Activity> instantiate(const Schema& schema, const Bindings& bindings,
                                      const Robot& robot) {
  const Bindings fixed = fixed_in_odom(bindings, robot);
  Arguments arguments;
  Bindings others;  // values that no argument can hold
  for (const auto& [name, value] : fixed) {
    Argument argument;
    if (to_argument(name, value, argument))
      arguments.push_back(std::move(argument));
    else if (value.truthy())
      others.emplace_back(name, value);
  }
  if (!schema.bind && !others.empty())
    throw ActivityError(schema.name + ": argument " + quoted(others.front().first) + " cannot be " +
                            kind_of(others.front().second),
                        v1::CODE_BAD_ARGUMENT);
  // An argument that the check cannot see counts as present.
  Schema rest = schema;
  if (schema.bind) {
    for (const auto& each_fixed : fixed) {
      const std::string& name = each_fixed.first;
      if (std::none_of(schema.parameters.begin(), schema.parameters.end(),
                       [&](const Parameter& each) { return normal(each.name) == normal(name); }))
        throw ActivityError(schema.name + " has no argument " + quoted(name) + ": it takes " +
                                names_of(schema.parameters),
                            v1::CODE_BAD_ARGUMENT);
      std::erase_if(rest.parameters, [&](const Parameter& each) {
        return normal(each.name) == normal(name) && saphira::find(arguments, name) == nullptr;
      });
    }
  }
  Arguments complete;
  const std::string wrong = check_arguments(rest, arguments, complete);
  if (!wrong.empty())
    throw ActivityError(wrong, v1::CODE_BAD_ARGUMENT);
  if (!schema.bind)
    return schema.make(complete);
  for (const Argument& argument : complete)
    others.emplace_back(argument.name, value_of(argument));
  return schema.bind(others);
}

}  // namespace saphira::intentions
