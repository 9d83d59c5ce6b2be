#include "saphira/behaviors/parameter.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"

namespace saphira::behaviors {
namespace {

bool finite(const Pose& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.th);
}

/// The error of the argument; empty: none.
std::string fault(const ParameterSpec& spec, const Argument& argument) {
  if (argument.kind != spec.kind)
    return std::string("expected ") + describe(spec.kind) + " (" + spec.meaning + ")";
  if (argument.kind == Kind::number) {
    // Written so that NaN is a fault.
    if (!(argument.number >= spec.low && argument.number <= spec.high))
      return "expected a number from " + plain(spec.low) + " to " + plain(spec.high) + " (" +
             spec.meaning + "), got " + plain(argument.number);
  } else if (argument.kind == Kind::text) {
    if (std::ranges::find(spec.choices, argument.text) == spec.choices.end())
      return "expected " + joined(spec.choices, " or ") + ", got \"" + argument.text.substr(0, 40) +
             "\"";
  } else {
    if (!finite(argument.point))
      return "expected a point with finite coordinates";
    if (argument.frame == Frame::map)
      return "expected a point in odom or in the robot's frame; where the map is is not known";
  }
  return {};
}

}  // namespace

std::optional<Parameters> Parameters::check(const std::vector<ParameterSpec>& specs,
                                            const std::vector<Argument>& arguments,
                                            const Pose& robot_in_odom, std::string& trouble) {
  for (const Argument& argument : arguments)
    if (std::ranges::none_of(specs,
                             [&](const ParameterSpec& s) { return s.name == argument.name; })) {
      trouble = "unknown parameter \"" + argument.name.substr(0, 40) + "\"; expected ";
      if (specs.empty())
        trouble += "none";
      for (const ParameterSpec& spec : specs)
        trouble += (&spec == &specs.front() ? "" : ", ") + spec.name;
      return {};
    }
  Parameters parameters;
  for (const ParameterSpec& spec : specs) {
    const auto given = std::ranges::find(arguments, spec.name, &Argument::name);
    if (given == arguments.end()) {
      if (spec.required) {
        trouble = "parameter \"" + spec.name + "\" is missing: expected " + describe(spec.kind) +
                  " (" + spec.meaning + ")";
        return {};
      }
      if (spec.kind == Kind::number)
        parameters.items_.push_back({spec.name, spec.usual});
      else if (spec.kind == Kind::text)
        parameters.items_.push_back({spec.name, spec.choices.front()});
      else
        parameters.items_.push_back({spec.name, std::monostate{}});
      continue;
    }
    if (const std::string wrong = fault(spec, *given); !wrong.empty()) {
      trouble = "parameter \"" + spec.name + "\": " + wrong;
      return {};
    }
    if (spec.kind == Kind::number) {
      parameters.items_.push_back({spec.name, given->number});
    } else if (spec.kind == Kind::text) {
      const auto choice = std::ranges::find(spec.choices, given->text);
      parameters.items_.push_back(
          {spec.name, given->text, static_cast<std::size_t>(choice - spec.choices.begin())});
    } else {
      parameters.items_.push_back({spec.name, given->frame == Frame::robot
                                                  ? compose(robot_in_odom, given->point)
                                                  : given->point});
    }
  }
  return parameters;
}

const Parameters::Item& Parameters::find(std::string_view name) const {
  for (const Item& item : items_)
    if (item.name == name)
      return item;
  throw std::logic_error("a behavior asked for a parameter that its schema does not have: " +
                         std::string(name));
}

double Parameters::number(std::string_view name) const {
  return std::get<double>(find(name).value);
}

std::optional<double> Parameters::number_if_any(std::string_view name) const {
  for (const Item& item : items_)
    if (const double* const number = std::get_if<double>(&item.value);
        number != nullptr && item.name == name)
      return *number;
  return {};
}

const std::string& Parameters::text(std::string_view name) const {
  return std::get<std::string>(find(name).value);
}

std::optional<Pose> Parameters::point(std::string_view name) const {
  for (const Item& item : items_)
    if (const Pose* const pose = std::get_if<Pose>(&item.value);
        pose != nullptr && item.name == name)
      return *pose;
  return {};
}

std::optional<Pose> Parameters::point(std::size_t index) const {
  const Pose* const pose = std::get_if<Pose>(&items_[index].value);
  return pose == nullptr ? std::optional<Pose>{} : *pose;
}

}  // namespace saphira::behaviors
