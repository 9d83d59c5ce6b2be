#include "slots.hpp"

#include <algorithm>
#include <utility>

#include "saphira/base/text.hpp"

namespace saphira::agent_interface {
namespace {

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t size = letter_size(text);
    if (size == 0)
      return false;
    text.remove_prefix(size);
  }
  return true;
}

}  // namespace

std::string misfit(const Functor& functor, const Arguments& arguments) {
  Arguments bound;
  for (const Argument& argument : arguments)
    if (argument.kind != ArgumentKind::unbound ||
        std::none_of(functor.parameters.begin(), functor.parameters.end(),
                     [&](const Parameter& one) { return one.name == argument.name; }))
      bound.push_back(argument);
  return complete(functor, bound);
}

std::string contradiction(const Functor& functor, const Answer& answer) {
  if (!is_utf8(answer.text))
    return "its text is not in UTF-8";
  for (const Argument& result : answer.results) {
    if (!is_utf8(result.name) || !is_utf8(result.text))
      return "a slot is not in UTF-8";
    const auto declared =
        std::find_if(functor.parameters.begin(), functor.parameters.end(),
                     [&](const Parameter& one) { return one.name == result.name; });
    if (declared == functor.parameters.end())
      return functor.name + " has no slot " + quoted(result.name);
    Arguments alone{result};
    if (std::string wrong = complete({functor.name, "", {optional(*declared)}}, alone);
        !wrong.empty())
      return wrong;
  }
  return {};
}

bool is_variable(const Argument& argument) {
  return argument.kind == ArgumentKind::unbound && !argument.text.empty();
}

Arguments with_values(Arguments arguments, const Arguments& bound) {
  for (Argument& argument : arguments) {
    if (!is_variable(argument))
      continue;
    const Argument* const value = find(bound, argument.text);
    std::string name = std::move(argument.name);
    argument = Argument{};
    argument.kind = ArgumentKind::unbound;
    if (value != nullptr)
      argument = *value;
    argument.name = std::move(name);
  }
  return arguments;
}

std::vector<Arguments> rows_of(const Arguments& part, const Arguments& bound,
                               const Arguments& results) {
  std::size_t count = 1;
  std::vector<std::pair<std::string, Arguments>> values;  // of each new variable
  for (const Argument& slot : part) {
    if (!is_variable(slot) || find(bound, slot.text) != nullptr)
      continue;
    Arguments of_slot;
    for (const Argument& result : results)
      if (result.name == slot.name && result.kind != ArgumentKind::unbound) {
        of_slot.push_back(result);
        of_slot.back().name = slot.text;
      }
    count = std::max(count, of_slot.size());
    if (!of_slot.empty())
      values.emplace_back(slot.text, std::move(of_slot));
  }
  std::vector<Arguments> rows;
  for (std::size_t i = 0; i < count; ++i) {
    Arguments row = bound;
    bool agrees = true;  // two slots of one variable have one value
    for (const auto& [name, of_slot] : values) {
      const Argument& value = of_slot[std::min(i, of_slot.size() - 1)];
      if (const Argument* const known = find(row, name); known != nullptr)
        agrees = agrees && *known == value;
      else
        row.push_back(value);
    }
    if (agrees)
      rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace saphira::agent_interface
