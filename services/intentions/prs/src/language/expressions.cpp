#include "language/expressions.hpp"

#include "saphira/base/guess.hpp"

namespace saphira::intentions {
namespace {

/// Special forms: they concern the intention itself, or evaluate only some arguments.
struct Special {
  const char* name;
  Expression::Kind kind;
  std::size_t fewest;
  std::size_t most;
};
constexpr Special kSpecials[] = {
    {"and", Expression::Kind::kAnd, 0, 64},        {"or", Expression::Kind::kOr, 0, 64},
    {"if", Expression::Kind::kIf, 2, 3},           {"state", Expression::Kind::kStateOf, 1, 1},
    {"level", Expression::Kind::kLevelOf, 1, 1},   {"finished", Expression::Kind::kFinished, 1, 1},
    {"outcome", Expression::Kind::kOutcome, 0, 0}, {"reason", Expression::Kind::kReason, 0, 0},
    {"elapsed", Expression::Kind::kElapsed, 0, 0}};

std::string count(std::size_t fewest, std::size_t most) {
  if (fewest == most)
    return std::to_string(fewest) + (fewest == 1 ? " argument" : " arguments");
  if (most > 64)
    return std::to_string(fewest) + " arguments or more";
  return std::to_string(fewest) + " to " + std::to_string(most) + " arguments";
}

std::vector<std::string> names_of(const Functions& functions) {
  std::vector<std::string> names;
  for (const Special& special : kSpecials)
    names.emplace_back(special.name);
  for (const auto& [name, function] : functions.functions())
    names.push_back(name);
  return names;
}

}  // namespace

Expression Expressions::expression(const Form& form, bool actions) {
  Expression result;
  if (form.quoted) {
    result.constant = literal(form);
    return result;
  }
  switch (form.kind) {
    case Form::Kind::kNumber:
    case Form::Kind::kText:
    case Form::Kind::kKeyword:
      result.constant = literal(form);
      return result;
    case Form::Kind::kName:
      return variable(form);
    case Form::Kind::kList:
      break;
  }
  if (form.items.empty())
    return result;
  const Form& head = form.items[0];
  if (head.kind != Form::Kind::kName || form.dotted)
    definition_.fail(form, "expected (function ...)" + found(form));
  return call(form, normal(head.text), actions);
}

Expression Expressions::variable(const Form& form) {
  Expression result;
  if (form.is("nil") || form.is("t")) {
    result.constant = literal(form);
    return result;
  }
  result.key = normal(form.text);
  result.name = form.text;
  const bool local = definition_.is_local(result.key);
  if (starred(form.text) || (!local && definition_.functions().condition(result.key) != nullptr)) {
    result.kind = Expression::Kind::kBelief;
    return result;
  }
  result.kind = Expression::Kind::kLocal;
  definition_.uses(form);
  result.slot = definition_.slot(form);
  return result;
}

Expression Expressions::call(const Form& form, const std::string& name, bool actions) {
  const Form& head = form.items[0];
  const std::size_t given = form.items.size() - 1;
  const auto expect = [&](std::size_t fewest, std::size_t most) {
    if (given < fewest || given > most)
      definition_.fail(form, "(" + head.text + ") expected " + count(fewest, most) + ", found " +
                                 std::to_string(given));
  };
  Expression result;
  using Kind = Expression::Kind;
  if (name == "quote") {
    expect(1, 1);
    result.constant = literal(form.items[1]);
    return result;
  }
  if (name == "setq")
    return set(form, actions);
  // A constant name: found without a call.
  if (name == "belief" && given == 1 &&
      (form.items[1].quoted || form.items[1].kind == Form::Kind::kText)) {
    result.kind = Kind::kBelief;
    const Value what = literal(form.items[1]);
    if (what.text() == nullptr)
      definition_.fail(form.items[1], "expected (belief 'name)" + found(form.items[1]));
    result.name = *what.text();
    result.key = normal(result.name);
    return result;
  }
  bool known = false;
  for (const Special& special : kSpecials) {
    if (name == special.name) {
      expect(special.fewest, special.most);
      result.kind = special.kind;
      known = true;
    }
  }
  if (!known) {
    if (const Function* const function = definition_.functions().function(name)) {
      expect(function->fewest, function->most);
      result.kind = Kind::kCall;
      result.function = shared(*function);
    } else if (const Action* const action = definition_.functions().action(name)) {
      if (!actions)
        definition_.fail(head, quoted(head.text) + " is an action: expected it within EXECUTE");
      expect(action->fewest, action->most);
      result.kind = Kind::kAction;
      result.action = std::make_shared<const Action>(*action);
    } else {
      definition_.fail(head, "unknown function " + quoted(head.text) +
                                 did_you_mean(name, names_of(definition_.functions())));
    }
  }
  if ((name == "say" || name == "format") && form.items[1].kind == Form::Kind::kText)
    check_blanks(form.items[1], given - 1);
  for (std::size_t i = 1; i < form.items.size(); ++i)
    result.arguments.push_back(expression(form.items[i], actions));
  return result;
}

/// Each ~a of a text has an argument.
void Expressions::check_blanks(const Form& text, std::size_t given) {
  std::size_t blanks = 0;
  for (std::size_t i = 0; i + 1 < text.text.size(); ++i)
    if (text.text[i] == '~')
      blanks += std::string_view("aAsS").find(text.text[++i]) != std::string_view::npos ? 1 : 0;
  if (blanks != given)
    definition_.fail(text, quoted(text.text) + " expected " + count(blanks, blanks) +
                               " for its ~a, found " + std::to_string(given));
}

Expression Expressions::set(const Form& form, bool actions) {
  if (!actions)
    definition_.fail(form, "setq is an action: expected it within EXECUTE");
  if (form.items.size() != 3 || form.items[1].kind != Form::Kind::kName)
    definition_.fail(form, "expected (setq variable value)" + found(form));
  const Form& name = form.items[1];
  definition_.check_variable(name);
  Expression result;
  result.kind = Expression::Kind::kSet;
  result.name = name.text;
  result.key = normal(name.text);
  result.slot = kNowhere;
  if (!starred(name.text)) {
    result.slot = definition_.slot(name);
    definition_.binds(name);
  }
  result.arguments.push_back(expression(form.items[2], actions));
  return result;
}

std::shared_ptr<const Function> Expressions::shared(const Function& function) {
  auto& kept = kept_[function.name];
  if (!kept)
    kept = std::make_shared<const Function>(function);
  return kept;
}

}  // namespace saphira::intentions
