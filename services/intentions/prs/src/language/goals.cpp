#include "language/goals.hpp"

#include <set>

#include "saphira/base/units.hpp"

namespace saphira::intentions {
namespace {

constexpr std::size_t kMostSteps = 4096;  ///< of one activity

constexpr const char* kGoals =
    "TEST, EXECUTE, =, WAIT, WAIT-FOR, ASK, INTEND, UNINTEND, IF, AND, SPLIT, GOTO, PRESERVE, "
    "MAINTAIN, "
    "SUCCEED or FAIL";

constexpr const char* kAsk = "(ASK question functor ((slot . value) ...) :timeout seconds)";
constexpr const char* kIntend = "(INTEND :schema ((parameter . value) ...) :blocking t :name name)";

std::string upper(std::string text) {
  for (char& c : text) {
    if (c >= 'a' && c <= 'z')
      c = static_cast<char>(c - 'a' + 'A');
  }
  return text;
}

}  // namespace

void Goals::body(const Form& goals) {
  if (!goals.is_list())
    definition_.fail(
        goals, "expected the goal-sets in parentheses: :goals '((INTEND ...) ...)" + found(goals));
  std::vector<std::vector<const Form*>> sets;
  std::vector<const Form*> places;
  for (const Form& item : goals.items) {
    if (!item.is_list() || item.items.empty()) {
      definition_.complain(item,
                           item.kind == Form::Kind::kKeyword
                               ? "expected a goal-set in parentheses: (:" + item.text + " goal ...)"
                               : "expected a goal-set" + found(item));
      continue;
    }
    std::vector<const Form*> each;
    Program::Set set;
    set.label = "S" + std::to_string(program_.sets.size() + 1);
    set.text = to_text(item);
    const Form& first = item.items[0];
    if (first.kind == Form::Kind::kKeyword) {
      set.label = upper(normal(first.text));
      if (!labels_.emplace(normal(first.text), program_.sets.size()).second)
        definition_.complain(first, "the label :" + first.text + " is there twice");
    }
    if (first.kind == Form::Kind::kName) {
      each.push_back(&item);
    } else {
      for (std::size_t i = first.is_list() ? 0 : 1; i < item.items.size(); ++i)
        each.push_back(&item.items[i]);
    }
    program_.sets.push_back(std::move(set));
    sets.push_back(std::move(each));
    places.push_back(&item);
  }
  if (program_.sets.empty())
    definition_.fail(goals, "expected at least one goal-set");
  std::vector<bool> completes;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    set_ = i;
    program_.sets[i].begin = program_.steps.size();
    completes.push_back(sequence(sets[i]));
    add(Step::Op::kEndSet, *places[i]);
  }
  for (const auto& [step, label] : gotos_) {
    const auto target = labels_.find(normal(label.text));
    if (target == labels_.end())
      definition_.complain(label, "no goal-set has the label :" + label.text);
    else
      program_.steps[step].target = target->second;
  }
  check_reached(completes, places);
}

void Goals::check_reached(const std::vector<bool>& completes,
                          const std::vector<const Form*>& places) {
  // The reachable goals, from the first set on.
  std::vector<bool> reached(places.size(), false);
  std::vector<std::size_t> open = {0};
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    if (at >= places.size() || reached[at])
      continue;
    reached[at] = true;
    if (completes[at])
      open.push_back(at + 1);
    for (const Step& step : program_.steps) {
      if (step.set == at && step.op == Step::Op::kGoto && step.target != kNowhere)
        open.push_back(step.target);
    }
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!reached[i])
      definition_.complain(*places[i], "this goal-set can never be reached");
  }
}

bool Goals::sequence(const std::vector<const Form*>& goals) {
  bool completes = true;
  bool told = false;
  for (const Form* const each : goals) {
    if (!completes && !told) {
      definition_.complain(*each, "this goal can never be reached");
      told = true;
    }
    try {
      completes = goal(*each) && completes;
    } catch (const Stop&) {
    }
  }
  return completes;
}

bool Goals::goal_or_goals(const Form& form) {
  if (form.is_list() && !form.items.empty() && form.items[0].is_list()) {
    std::vector<const Form*> each;
    for (const Form& item : form.items)
      each.push_back(&item);
    return sequence(each);
  }
  return goal(form);
}

std::size_t Goals::add(Step::Op op, const Form& at) {
  if (program_.steps.size() >= kMostSteps)
    definition_.fail(
        at, "expected an activity of no more than " + std::to_string(kMostSteps) + " steps");
  Step step;
  step.op = op;
  step.set = set_;
  step.line = at.line;
  step.text = to_text(at);
  program_.steps.push_back(std::move(step));
  return program_.steps.size() - 1;
}

bool Goals::otherwise(std::size_t failing, const Form* form) {
  if (form == nullptr)
    return false;
  const std::size_t jump = add(Step::Op::kJump, *form);
  step(failing).other = here();
  const bool completes = goal_or_goals(*form);
  step(jump).target = here();
  return completes;
}

void Goals::expect_items(const Form& form, const Parts& given, std::size_t fewest, std::size_t most,
                         const char* pattern) {
  if (given.items.size() < fewest || given.items.size() > most)
    definition_.fail(form, std::string("expected ") + pattern + found(form));
}

bool Goals::goal(const Form& form) {
  if (!form.is_list() || form.items.empty() || form.items[0].kind != Form::Kind::kName)
    definition_.fail(form, std::string("expected a goal: ") + kGoals + found(form));
  const Form& head = form.items[0];
  const std::string op = normal(head.text);
  if (op == "test")
    return test(form);
  if (op == "execute") {
    const Parts given = definition_.parts(form, 1, {});
    expect_items(form, given, 1, 1, "(EXECUTE (action ...))");
    const std::size_t at = add(Step::Op::kExecute, form);
    take(at, *given.items[0], true);
    return true;
  }
  if (op == "=")
    return assign(form);
  if (op == "wait")
    return pause(form);
  if (op == "wait-for")
    return wait(form);
  if (op == "ask")
    return ask(form);
  if (op == "intend")
    return intend(form);
  if (op == "unintend") {
    if (form.items.size() != 2)
      definition_.fail(form, "expected (UNINTEND 'name)" + found(form));
    const std::size_t at = add(Step::Op::kUnintend, form);
    take(at, form.items[1], false);
    return true;
  }
  if (op == "if")
    return branch(form);
  if (op == "and" || op == "split")
    return fork(form, op == "and" ? Step::Op::kFork : Step::Op::kSplit);
  if (op == "seq" || op == "progn") {
    std::vector<const Form*> each;
    for (std::size_t i = 1; i < form.items.size(); ++i)
      each.push_back(&form.items[i]);
    return sequence(each);
  }
  if (op == "goto") {
    if (form.items.size() != 2 || form.items[1].kind != Form::Kind::kKeyword)
      definition_.fail(form, "expected (GOTO :label)" + found(form));
    gotos_.emplace_back(add(Step::Op::kGoto, form), form.items[1]);
    return false;
  }
  if (op == "preserve" || op == "maintain")
    return guard(form, op == "preserve" ? Step::Op::kPreserve : Step::Op::kMaintain);
  if (op == "succeed" || op == "fail") {
    const std::size_t at = add(op == "succeed" ? Step::Op::kSucceed : Step::Op::kFail, form);
    if (form.items.size() > 1) {
      Form words = form;
      words.items[0].text = "format";
      step(at).reason = expressions_.expression(words, false);
    }
    return false;
  }
  definition_.fail(head, "unknown goal " + quoted(head.text) + ": expected " + kGoals);
}

void Goals::take(std::size_t at, const Form& form, bool actions) {
  Expression compiled = expressions_.expression(form, actions);
  step(at).expression = std::move(compiled);
}

bool Goals::test(const Form& form) {
  const Parts given = definition_.parts(form, 1, {"reason", "else"});
  expect_items(form, given, 1, 1, "(TEST condition)");
  const std::size_t at = add(Step::Op::kTest, form);
  take(at, *given.items[0], false);
  step(at).text = to_text(*given.items[0]);
  if (const Form* const reason = given.option("reason"))
    step(at).reason = expressions_.expression(*reason, false);
  otherwise(at, given.option("else"));
  return true;
}

bool Goals::assign(const Form& form) {
  if (form.items.size() != 3 || form.items[1].kind != Form::Kind::kName)
    definition_.fail(form, "expected (= variable value)" + found(form));
  const Form& name = form.items[1];
  if (starred(name.text))
    definition_.fail(name, "expected a local variable; (EXECUTE (setq " + name.text +
                               " ...)) sets an environment variable");
  definition_.check_variable(name);
  const std::size_t at = add(Step::Op::kAssign, form);
  take(at, form.items[2], false);
  step(at).slot = definition_.slot(name);
  definition_.binds(name);
  return true;
}

/// The condition of a step, for people.
void Goals::tell(std::size_t at, const Form& condition) {
  step(at).text = to_text(condition);
  const Condition* const known = condition.kind == Form::Kind::kName
                                     ? definition_.functions().condition(normal(condition.text))
                                     : nullptr;
  constexpr std::string_view kWhether = "whether ";
  if (known != nullptr && known->summary.starts_with(kWhether))
    step(at).words = known->summary.substr(kWhether.size());
}

/// [s] A constant has no other unit, and is not negative.
Expression Goals::duration(const Form& form) {
  const Unit* const unit = find_unit(form.unit);
  if (form.kind == Form::Kind::kNumber &&
      (form.number < 0.0 || (unit != nullptr && unit->si != "s")))
    definition_.fail(form, "expected a time in seconds, such as 60s" + found(form));
  return expressions_.expression(form, false);
}

/// Waits for the end of its time only.
bool Goals::pause(const Form& form) {
  const Parts given = definition_.parts(form, 1, {});
  expect_items(form, given, 1, 1, "(WAIT seconds), such as (WAIT 5s)");
  const std::size_t at = add(Step::Op::kWait, form);
  step(at).text = to_text(*given.items[0]);
  step(at).timeout = duration(*given.items[0]);
  Form nothing = form;
  nothing.kind = Form::Kind::kName;
  nothing.text = "nil";
  nothing.items.clear();
  take(at, nothing, false);
  step(at).other = here();
  return true;
}

bool Goals::wait(const Form& form) {
  const Parts given = definition_.parts(form, 1, {"timeout", "else", "forever"});
  expect_items(form, given, 1, 1, "(WAIT-FOR condition)");
  const std::size_t at = add(Step::Op::kWait, form);
  take(at, *given.items[0], false);
  tell(at, *given.items[0]);
  const Form* const timeout = given.option("timeout");
  if (timeout != nullptr)
    step(at).timeout = duration(*timeout);
  if (given.option("else") != nullptr && timeout == nullptr)
    definition_.fail(*given.option("else"), "expected :else together with :timeout");
  if (timeout == nullptr && program_.timeout <= 0.0 && given.option("forever") == nullptr)
    definition_.warn(form,
                     "waits without limit: expected :timeout seconds, or :forever t to say so");
  otherwise(at, given.option("else"));
  return true;
}

/// Asks, waits, and tests for a good answer.
bool Goals::ask(const Form& form) {
  const Parts given = definition_.parts(form, 1, {"timeout", "else"});
  expect_items(form, given, 2, 3, kAsk);
  const Form& question = *given.items[0];
  const Form& functor = *given.items[1];
  if (question.kind != Form::Kind::kName || starred(question.text) || functor.is_list() ||
      functor.kind == Form::Kind::kNumber || given.option("timeout") == nullptr)
    definition_.fail(form, std::string("expected ") + kAsk + found(form));
  definition_.check_variable(question);

  const auto word = [&](const Form& name) {
    Form text = name;
    text.kind = Form::Kind::kText;
    return text;
  };
  const auto call = [&](const char* function) {
    Form list;
    list.line = form.line;
    list.column = form.column;
    list.items.push_back(question);
    list.items[0].text = function;
    return list;
  };
  Form asks = call("ask-agents");
  asks.items.push_back(word(functor));
  const Form* const slots = given.items.size() > 2 ? given.items[2] : nullptr;
  if (slots != nullptr && !slots->is_list() && !slots->is("nil"))
    definition_.fail(*slots, "expected the slots: ((slot . value) ...)" + found(*slots));
  for (std::size_t i = 0; slots != nullptr && i < slots->items.size(); ++i) {
    const Form& slot = slots->items[i];
    if (!slot.is_list() || slot.items.size() != 2 || slot.items[0].kind != Form::Kind::kName)
      definition_.fail(slot, "expected (slot . value)" + found(slot));
    asks.items.push_back(word(slot.items[0]));
    asks.items.push_back(slot.items[1]);
  }
  const std::size_t begins = add(Step::Op::kAssign, form);
  take(begins, asks, true);
  step(begins).slot = definition_.slot(question);
  definition_.binds(question);

  const auto of_question = [&](const char* function) {
    Form list = call(function);
    list.items.push_back(question);
    return list;
  };
  const std::size_t waits = add(Step::Op::kWait, form);
  take(waits, of_question("answered"), false);
  step(waits).text = "an answer to " + functor.text;
  step(waits).timeout = duration(*given.option("timeout"));
  const std::size_t tests = add(Step::Op::kTest, form);
  take(tests, of_question("answered-well"), false);
  step(tests).reason = expressions_.expression(of_question("answer-text"), false);
  otherwise(tests, given.option("else"));
  step(waits).other = step(tests).other;
  return true;
}

bool Goals::intend(const Form& form) {
  if (form.items.size() < 2 || form.items[1].is_list() ||
      form.items[1].kind == Form::Kind::kNumber || form.items[1].text.empty())
    definition_.fail(form, std::string("expected ") + kIntend + found(form));
  const Parts given =
      definition_.parts(form, 2, {"blocking", "name", "timeout", "priority", "else"});
  expect_items(form, given, 0, 1, kIntend);
  const std::size_t at = add(Step::Op::kIntend, form);
  auto intend = std::make_shared<Intend>();
  intend->schema = form.items[1].text;
  Mention mention;
  mention.schema = intend->schema;
  mention.line = form.items[1].line;
  mention.column = form.items[1].column;
  mention.line_text = definition_.line_text(mention.line);
  if (!given.items.empty() && !given.items[0]->is("nil"))
    arguments(*given.items[0], *intend, mention);
  if (const Form* const blocking = given.option("blocking")) {
    if (blocking->is("nil"))
      intend->waits = false;
    else if (!blocking->is("t"))
      intend->threshold = expressions_.expression(*blocking, false);
    if (blocking->kind == Form::Kind::kNumber && (blocking->number < 0.0 || blocking->number > 1.0))
      definition_.complain(*blocking,
                           "expected t, nil, or a degree from 0 to 1" + found(*blocking));
  }
  if (const Form* const name = given.option("name")) {
    if (name->is_list() || name->kind == Form::Kind::kNumber || name->text.empty())
      definition_.fail(*name, "expected a name" + found(*name));
    intend->name = name->text;
  }
  if (const Form* const timeout = given.option("timeout"))
    intend->timeout = duration(*timeout);
  if (const Form* const priority = given.option("priority"))
    intend->priority = expressions_.expression(*priority, false);
  step(at).text = "intends " + intend->schema;
  step(at).intend = std::move(intend);
  program_.mentions.push_back(std::move(mention));
  otherwise(at, given.option("else"));
  return true;
}

void Goals::arguments(const Form& form, Intend& intend, Mention& mention) {
  if (!form.is_list())
    definition_.fail(form, "expected the arguments: ((parameter . value) ...)" + found(form));
  std::set<std::string> names;
  for (const Form& item : form.items) {
    if (!item.is_list() || item.items.size() != 2 || item.items[0].is_list() ||
        item.items[0].kind == Form::Kind::kNumber) {
      definition_.complain(item, "expected (parameter . value)" + found(item));
      continue;
    }
    if (!names.insert(normal(item.items[0].text)).second)
      definition_.complain(item, "argument " + quoted(item.items[0].text) + " is given twice");
    intend.arguments.emplace_back(item.items[0].text,
                                  expressions_.expression(item.items[1], false));
    mention.arguments.push_back(item.items[0].text);
    mention.lines.push_back(item.line);
    mention.columns.push_back(item.column);
    mention.argument_texts.push_back(definition_.line_text(item.line));
  }
}

bool Goals::branch(const Form& form) {
  const Parts given = definition_.parts(form, 1, {"else"});
  expect_items(form, given, 2, given.option("else") == nullptr ? 3 : 2,
               "(IF condition goal [goal])");
  const std::size_t at = add(Step::Op::kJumpUnless, form);
  take(at, *given.items[0], false);
  bool completes = goal_or_goals(*given.items[1]);
  const Form* const other = given.items.size() > 2 ? given.items[2] : given.option("else");
  if (other == nullptr) {
    step(at).target = here();
    return true;
  }
  const std::size_t jump = add(Step::Op::kJump, form);
  step(at).target = here();
  completes = goal_or_goals(*other) || completes;
  step(jump).target = here();
  return completes;
}

bool Goals::fork(const Form& form, Step::Op op) {
  const Parts given =
      op == Step::Op::kFork ? definition_.parts(form, 1, {"else"}) : definition_.parts(form, 1, {});
  if (given.items.empty())
    definition_.fail(form, "expected goals" + found(form));
  const std::size_t at = add(op, form);
  for (const Form* const each : given.items)
    add_branch(at, *each, form);
  step(at).target = here();
  otherwise(at, given.option("else"));
  return true;
}

void Goals::add_branch(std::size_t at, const Form& form, const Form& whole) {
  step(at).branches.push_back(here());
  try {
    goal_or_goals(form);
  } catch (const Stop&) {
  }
  add(Step::Op::kEndThread, whole);
}

bool Goals::guard(const Form& form, Step::Op op) {
  const bool maintains = op == Step::Op::kMaintain;
  const Parts given =
      maintains ? definition_.parts(form, 1, {"by", "else"}) : definition_.parts(form, 1, {"else"});
  if (given.items.size() < 2 || (maintains && given.option("by") == nullptr))
    definition_.fail(form, std::string("expected ") +
                               (maintains ? "(MAINTAIN condition :by goal goal ...)"
                                          : "(PRESERVE condition goal ...)") +
                               found(form));
  const std::size_t at = add(op, form);
  take(at, *given.items[0], false);
  tell(at, *given.items[0]);
  step(at).branches.push_back(here());
  sequence({given.items.begin() + 1, given.items.end()});
  add(Step::Op::kEndThread, form);
  if (maintains)
    add_branch(at, *given.option("by"), form);
  step(at).target = here();
  otherwise(at, given.option("else"));
  return true;
}

}  // namespace saphira::intentions
