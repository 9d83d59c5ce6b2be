#include "names.hpp"

#include <algorithm>

#include "saphira/base/guess.hpp"
#include "saphira/base/text.hpp"

namespace saphira::behaviors::language {
namespace {

constexpr Quick kQuick[] = {
    {"straight_up", 3, Op::up},     {"up_straight", 3, Op::up}, {"down_straight", 3, Op::down},
    {"straight_down", 3, Op::down}, {"min", 2, Op::smallest},   {"max", 2, Op::largest},
    {"fmin", 2, Op::smallest},      {"fmax", 2, Op::largest},   {"f_and", 2, Op::smallest},
    {"f_or", 2, Op::largest},       {"abs", 1, Op::magnitude},  {"fabs", 1, Op::magnitude},
};

/// Functions that the compiler makes of several instructions.
constexpr const char* kComposed[] = {"f_greater", "f_smaller", "f_eq", "f_not"};

bool is_constant(std::string_view name) {
  return std::ranges::any_of(constants(), [&](const Constant& c) { return name == c.name; });
}

std::string known(const std::vector<std::string>& names) {
  return ": expected one of " + joined(names);
}

}  // namespace

const Quick* find_quick(std::string_view name) {
  const auto* const found = std::ranges::find(kQuick, name, &Quick::name);
  return found == std::end(kQuick) ? nullptr : found;
}

const Function* find_function(std::string_view name) {
  const auto found = std::ranges::find(functions(), name, &Function::name);
  return found == functions().end() ? nullptr : &*found;
}

bool is_function(std::string_view name) {
  return find_function(name) != nullptr || find_quick(name) != nullptr ||
         std::ranges::find(kComposed, name) != std::end(kComposed);
}

bool reserved(std::string_view name) {
  return name == "sfPreferredTurnDir" || name == "sfRobot" || is_constant(name) ||
         is_function(name);
}

std::string meant_variable(const std::string& name, const Variables& variables) {
  std::vector<std::string> names;
  for (const auto& [known, variable] : variables)
    names.push_back(known);
  for (const Constant& constant : constants())
    names.emplace_back(constant.name);
  return did_you_mean(name, names, known(names));
}

std::string meant_function(const std::string& name) {
  std::vector<std::string> names;
  for (const Function& function : functions())
    names.emplace_back(function.name);
  for (const Quick& quick : kQuick)
    names.emplace_back(quick.name);
  names.insert(names.end(), std::begin(kComposed), std::end(kComposed));
  return did_you_mean(name, names, known(names));
}

}  // namespace saphira::behaviors::language
