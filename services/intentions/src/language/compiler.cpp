#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "language/program.hpp"
#include "language/reader.hpp"
#include "saphira/base/text.hpp"
#include "saphira/intentions/language.hpp"

namespace saphira::intentions {
namespace {

constexpr std::size_t kMostSteps = 4096;  ///< of one activity

struct Stop {};  ///< a mistake has been noted; the form is given up

constexpr const char* kGoals =
    "TEST, EXECUTE, =, WAIT-FOR, INTEND, UNINTEND, IF, AND, SPLIT, GOTO, PRESERVE, MAINTAIN, "
    "SUCCEED or FAIL";

constexpr const char* kIntend = "(INTEND :schema ((parameter . value) ...) :blocking t :name name)";

/// What looks like a function and is about the intention itself, or evaluates only some arguments.
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

bool starred(std::string_view name) {
  return name.size() > 2 && name.front() == '*' && name.back() == '*';
}

std::string upper(std::string text) {
  for (char& c : text) {
    if (c >= 'a' && c <= 'z')
      c = static_cast<char>(c - 'a' + 'A');
  }
  return text;
}

std::string count(std::size_t fewest, std::size_t most) {
  if (fewest == most)
    return std::to_string(fewest) + (fewest == 1 ? " argument" : " arguments");
  if (most > 64)
    return std::to_string(fewest) + " arguments or more";
  return std::to_string(fewest) + " to " + std::to_string(most) + " arguments";
}

/// Compiles one (defintention ...).
class Compiler {
 public:
  Compiler(const Reader& reader, const Functions& functions, std::vector<Diagnostic>& troubles)
      : reader_(reader), functions_(functions), troubles_(troubles) {}

  /// No schema where there was a mistake.
  std::optional<Schema> compile(const Form& form, const std::string& file) {
    const std::size_t before = errors_;
    try {
      definition(form, file);
    } catch (const Stop&) {
    }
    if (errors_ > before)
      return std::nullopt;
    return finish();
  }

 private:
  // --- mistakes

  void complain(const Form& at, std::string message) {
    ++errors_;
    troubles_.push_back(reader_.trouble(at.line, at.column, true, std::move(message)));
  }
  [[noreturn]] void fail(const Form& at, std::string message) {
    complain(at, std::move(message));
    throw Stop();
  }
  void warn(const Form& at, std::string message) {
    troubles_.push_back(reader_.trouble(at.line, at.column, false, std::move(message)));
  }
  static std::string found(const Form& form) { return ", found " + quoted(to_text(form)); }

  /// The positional items and the options (:key value) of a list, from its second item on.
  struct Parts {
    std::vector<const Form*> items;
    std::map<std::string, const Form*> options;
    const Form* option(const std::string& key) const {
      const auto it = options.find(key);
      return it == options.end() ? nullptr : it->second;
    }
  };
  Parts parts(const Form& form, std::size_t from, const std::set<std::string>& known) {
    Parts result;
    for (std::size_t i = from; i < form.items.size(); ++i) {
      const Form& item = form.items[i];
      if (item.kind != Form::Kind::kKeyword) {
        result.items.push_back(&item);
        continue;
      }
      const std::string key = normal(item.text);
      if (!known.contains(key)) {
        std::string names;
        for (const std::string& each : known)
          names += (names.empty() ? ":" : ", :") + each;
        fail(item, known.empty() ? "expected no option" + found(item)
                                 : "expected one of " + names + found(item));
      }
      if (i + 1 == form.items.size())
        fail(item, "expected a value after :" + key);
      if (!result.options.emplace(key, &form.items[++i]).second)
        fail(item, ":" + key + " is given twice");
    }
    return result;
  }

  // --- the definition

  void definition(const Form& form, const std::string& file) {
    program_->file = file;
    program_->line = form.line;
    if (!form.is_list() || form.items.empty() || !form.items[0].is("defintention"))
      fail(form, "expected (defintention :name ...)" + found(form));
    if (form.items.size() < 2 || form.items[1].is_list() ||
        form.items[1].kind == Form::Kind::kNumber || form.items[1].text.empty())
      fail(form.items.size() < 2 ? form : form.items[1],
           "expected the activity's name, such as :plan-and-execute");
    program_->name = form.items[1].text;
    const Parts given = parts(
        form, 2,
        {"params", "goals", "timeout", "priority", "concurrent", "level", "progress",
         "documentation", "doc"});
    if (!given.items.empty())
      fail(*given.items[0], "expected :params, :goals or another option" + found(*given.items[0]));
    if (const Form* const params = given.option("params"))
      parameters(*params);
    program_->parameters = program_->locals.size();
    for (const char* const key : {"documentation", "doc"}) {
      if (const Form* const doc = given.option(key)) {
        if (doc->kind != Form::Kind::kText)
          fail(*doc, "expected a text" + found(*doc));
        summary_ = doc->text;
      }
    }
    if (const Form* const timeout = given.option("timeout"))
      program_->timeout = constant_number(*timeout, 0.1, 1e7, "seconds");
    if (const Form* const priority = given.option("priority"))
      priority_ = static_cast<int>(constant_number(*priority, -1000.0, 1000.0, "a whole number"));
    if (const Form* const concurrent = given.option("concurrent"))
      concurrent_ = literal(*concurrent).truthy();
    const Form* const goals = given.option("goals");
    if (goals == nullptr)
      fail(form, "expected :goals '(...)");
    if (const Form* const level = given.option("level"))
      program_->level = expression(*level, false);
    if (const Form* const progress = given.option("progress"))
      program_->progress = expression(*progress, false);
    body(*goals);
    for (const auto& [name, use] : pending_) {
      if (!assigned_.contains(name))
        complain(use, "unknown variable " + quoted(use.text) +
                          ": expected a parameter, a variable that = binds, *an-environment-"
                          "variable* or a condition");
    }
  }

  double constant_number(const Form& form, double low, double high, const char* what) {
    if (form.kind != Form::Kind::kNumber || form.number < low || form.number > high)
      fail(form, "expected " + std::string(what) + " from " + plain(low) + " to " + plain(high) +
                     found(form));
    return form.number;
  }

  void parameters(const Form& form) {
    if (form.is("nil"))
      return;
    if (!form.is_list())
      fail(form, "expected the parameters in parentheses" + found(form));
    for (const Form& item : form.items)
      parameter(item);
  }

  void parameter(const Form& form) {
    const Form& name = form.is_list() && !form.items.empty() ? form.items[0] : form;
    if (name.kind != Form::Kind::kName || starred(name.text))
      fail(name, "expected a parameter, such as dest or (speed :number 0.3)" + found(name));
    if (slots_.contains(normal(name.text)))
      fail(name, "parameter " + quoted(name.text) + " is there twice");
    Parameter parameter;
    parameter.name = name.text;
    parameter.any = true;
    parameter.required = true;
    parameter.low = -1e9;
    parameter.high = 1e9;
    Value usual;
    if (form.is_list()) {
      std::size_t next = 1;
      if (next < form.items.size() && form.items[next].kind == Form::Kind::kKeyword) {
        const Form& type = form.items[next];
        bool known = true;
        if (type.is("number"))
          parameter.kind = ArgumentKind::kNumber;
        else if (type.is("text") || type.is("place") || type.is("symbol") || type.is("name"))
          parameter.kind = ArgumentKind::kText;
        else if (type.is("point"))
          parameter.kind = ArgumentKind::kPoint;
        else
          known = false;
        if (known)
          parameter.any = false;
        if (known || type.is("any") || type.is("list"))
          ++next;
        else if (!type.is("unit") && !type.is("low") && !type.is("high") && !type.is("doc"))
          fail(type, "expected :number, :text, :place, :point, :list or :any" + found(type));
      }
      if (next < form.items.size() && form.items[next].kind != Form::Kind::kKeyword) {
        usual = literal(form.items[next]);
        parameter.required = false;
        const bool fits = usual.nil() || parameter.any ||
                          (parameter.kind == ArgumentKind::kNumber && usual.number() != nullptr) ||
                          (parameter.kind == ArgumentKind::kText && usual.text() != nullptr);
        if (!fits)
          fail(form.items[next],
               "expected a default of the parameter's type" + found(form.items[next]));
        ++next;
      }
      const Parts options = parts(form, next, {"unit", "low", "high", "doc"});
      if (!options.items.empty())
        fail(*options.items[0], "expected :unit, :low, :high or :doc" + found(*options.items[0]));
      if (const Form* const unit = options.option("unit"))
        parameter.unit = unit->text;
      if (const Form* const low = options.option("low"))
        parameter.low = constant_number(*low, -1e9, 1e9, "a number");
      if (const Form* const high = options.option("high"))
        parameter.high = constant_number(*high, -1e9, 1e9, "a number");
      if (parameter.low > parameter.high)
        fail(form, "expected :low below :high");
      if (const double* const given = usual.number())
        if (!parameter.any && (*given < parameter.low || *given > parameter.high))
          fail(form, "expected a default within :low and :high");
    }
    if (const double* const given = usual.number())
      parameter.usual = *given;
    else if (const std::string* const given_text = usual.text())
      parameter.usual_text = *given_text;
    slots_[normal(name.text)] = program_->locals.size();
    assigned_.insert(normal(name.text));
    program_->locals.push_back(name.text);
    program_->usual.push_back(std::move(usual));
    parameters_.push_back(std::move(parameter));
  }

  // --- goal-sets

  void body(const Form& goals) {
    if (!goals.is_list())
      fail(goals,
           "expected the goal-sets in parentheses: :goals '((INTEND ...) ...)" + found(goals));
    std::vector<std::vector<const Form*>> sets;
    std::vector<const Form*> places;
    for (const Form& item : goals.items) {
      if (!item.is_list() || item.items.empty()) {
        complain(item, item.kind == Form::Kind::kKeyword
                           ? "expected a goal-set in parentheses: (:" + item.text + " goal ...)"
                           : "expected a goal-set" + found(item));
        continue;
      }
      std::vector<const Form*> each;
      Program::Set set;
      set.label = "S" + std::to_string(program_->sets.size() + 1);
      set.text = to_text(item);
      const Form& first = item.items[0];
      if (first.kind == Form::Kind::kKeyword) {
        set.label = upper(normal(first.text));
        if (!labels_.emplace(normal(first.text), program_->sets.size()).second)
          complain(first, "the label :" + first.text + " is there twice");
      }
      if (first.kind == Form::Kind::kName) {
        each.push_back(&item);
      } else {
        for (std::size_t i = first.is_list() ? 0 : 1; i < item.items.size(); ++i)
          each.push_back(&item.items[i]);
      }
      program_->sets.push_back(std::move(set));
      sets.push_back(std::move(each));
      places.push_back(&item);
    }
    if (program_->sets.empty())
      fail(goals, "expected at least one goal-set");
    std::vector<bool> completes;
    for (std::size_t i = 0; i < sets.size(); ++i) {
      set_ = i;
      program_->sets[i].begin = program_->steps.size();
      completes.push_back(sequence(sets[i]));
      add(Step::Op::kEndSet, *places[i]);
    }
    for (const auto& [step, label] : gotos_) {
      const auto target = labels_.find(normal(label.text));
      if (target == labels_.end())
        complain(label, "no goal-set has the label :" + label.text);
      else
        program_->steps[step].target = target->second;
    }
    // What can be reached, from the first set on.
    std::vector<bool> reached(sets.size(), false);
    std::vector<std::size_t> open = {0};
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      if (at >= sets.size() || reached[at])
        continue;
      reached[at] = true;
      if (completes[at])
        open.push_back(at + 1);
      for (const Step& step : program_->steps) {
        if (step.set == at && step.op == Step::Op::kGoto && step.target != kNowhere)
          open.push_back(step.target);
      }
    }
    for (std::size_t i = 0; i < sets.size(); ++i) {
      if (!reached[i])
        complain(*places[i], "this goal-set can never be reached");
    }
  }

  /// Whether what is behind it can be reached.
  bool sequence(const std::vector<const Form*>& goals) {
    bool completes = true;
    bool told = false;
    for (const Form* const each : goals) {
      if (!completes && !told) {
        complain(*each, "this goal can never be reached");
        told = true;
      }
      try {
        completes = goal(*each) && completes;
      } catch (const Stop&) {
      }
    }
    return completes;
  }

  /// A goal, or a list of goals one after the other.
  bool goal_or_goals(const Form& form) {
    if (form.is_list() && !form.items.empty() && form.items[0].is_list()) {
      std::vector<const Form*> each;
      for (const Form& item : form.items)
        each.push_back(&item);
      return sequence(each);
    }
    return goal(form);
  }

  std::size_t add(Step::Op op, const Form& at) {
    if (program_->steps.size() >= kMostSteps)
      fail(at, "expected an activity of no more than " + std::to_string(kMostSteps) + " steps");
    Step step;
    step.op = op;
    step.set = set_;
    step.line = at.line;
    step.text = to_text(at);
    program_->steps.push_back(std::move(step));
    return program_->steps.size() - 1;
  }
  Step& step(std::size_t index) { return program_->steps[index]; }
  std::size_t here() const { return program_->steps.size(); }

  /// The goals of an :else, behind the step that may fail; both meet behind them.
  bool otherwise(std::size_t failing, const Form* form) {
    if (form == nullptr)
      return false;
    const std::size_t jump = add(Step::Op::kJump, *form);
    step(failing).other = here();
    const bool completes = goal_or_goals(*form);
    step(jump).target = here();
    return completes;
  }

  void expect_items(const Form& form, const Parts& given, std::size_t fewest, std::size_t most,
                    const char* pattern) {
    if (given.items.size() < fewest || given.items.size() > most)
      fail(form, std::string("expected ") + pattern + found(form));
  }

  bool goal(const Form& form) {
    if (!form.is_list() || form.items.empty() || form.items[0].kind != Form::Kind::kName)
      fail(form, std::string("expected a goal: ") + kGoals + found(form));
    const Form& head = form.items[0];
    const std::string op = normal(head.text);
    if (op == "test")
      return test(form);
    if (op == "execute") {
      const Parts given = parts(form, 1, {});
      expect_items(form, given, 1, 1, "(EXECUTE (action ...))");
      const std::size_t at = add(Step::Op::kExecute, form);
      take(at, *given.items[0], true);
      return true;
    }
    if (op == "=")
      return assign(form);
    if (op == "wait-for")
      return wait(form);
    if (op == "intend")
      return intend(form);
    if (op == "unintend") {
      if (form.items.size() != 2)
        fail(form, "expected (UNINTEND 'name)" + found(form));
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
        fail(form, "expected (GOTO :label)" + found(form));
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
        step(at).reason = expression(words, false);
      }
      return false;
    }
    fail(head, "unknown goal " + quoted(head.text) + ": expected " + kGoals);
  }

  void take(std::size_t at, const Form& form, bool actions) {
    Expression compiled = expression(form, actions);
    step(at).expression = std::move(compiled);
    step(at).has_expression = true;
  }

  bool test(const Form& form) {
    const Parts given = parts(form, 1, {"reason", "else"});
    expect_items(form, given, 1, 1, "(TEST condition)");
    const std::size_t at = add(Step::Op::kTest, form);
    take(at, *given.items[0], false);
    step(at).text = to_text(*given.items[0]);
    if (const Form* const reason = given.option("reason"))
      step(at).reason = expression(*reason, false);
    otherwise(at, given.option("else"));
    return true;
  }

  bool assign(const Form& form) {
    if (form.items.size() != 3 || form.items[1].kind != Form::Kind::kName)
      fail(form, "expected (= variable value)" + found(form));
    const Form& name = form.items[1];
    if (starred(name.text))
      fail(name, "expected a local variable; (EXECUTE (setq " + name.text +
                     " ...)) sets an environment variable");
    check_variable(name);
    const std::size_t at = add(Step::Op::kAssign, form);
    take(at, form.items[2], false);
    step(at).slot = slot(name);
    assigned_.insert(normal(name.text));
    return true;
  }

  void check_variable(const Form& name) {
    if (name.is("t") || name.is("nil") || functions_.condition(normal(name.text)) != nullptr)
      fail(name, quoted(name.text) + " cannot be set");
  }

  bool wait(const Form& form) {
    const Parts given = parts(form, 1, {"timeout", "else", "forever"});
    expect_items(form, given, 1, 1, "(WAIT-FOR condition)");
    const std::size_t at = add(Step::Op::kWait, form);
    take(at, *given.items[0], false);
    step(at).text = to_text(*given.items[0]);
    const Form* const timeout = given.option("timeout");
    if (timeout != nullptr)
      step(at).timeout = expression(*timeout, false);
    if (given.option("else") != nullptr && timeout == nullptr)
      fail(*given.option("else"), "expected :else together with :timeout");
    if (timeout == nullptr && program_->timeout <= 0.0 && given.option("forever") == nullptr)
      warn(form, "waits without limit: expected :timeout seconds, or :forever t to say so");
    otherwise(at, given.option("else"));
    return true;
  }

  bool intend(const Form& form) {
    if (form.items.size() < 2 || form.items[1].is_list() ||
        form.items[1].kind == Form::Kind::kNumber || form.items[1].text.empty())
      fail(form, std::string("expected ") + kIntend + found(form));
    const Parts given = parts(form, 2, {"blocking", "name", "timeout", "priority", "else"});
    expect_items(form, given, 0, 1, kIntend);
    const std::size_t at = add(Step::Op::kIntend, form);
    auto intend = std::make_shared<Intend>();
    intend->schema = form.items[1].text;
    Mention mention;
    mention.schema = intend->schema;
    mention.line = form.items[1].line;
    mention.column = form.items[1].column;
    mention.line_text = reader_.trouble(mention.line, 1, true, {}).line_text;
    if (!given.items.empty() && !given.items[0]->is("nil"))
      arguments(*given.items[0], *intend, mention);
    if (const Form* const blocking = given.option("blocking")) {
      if (blocking->is("nil"))
        intend->waits = false;
      else if (!blocking->is("t"))
        intend->threshold = expression(*blocking, false);
      if (blocking->kind == Form::Kind::kNumber &&
          (blocking->number < 0.0 || blocking->number > 1.0))
        complain(*blocking, "expected t, nil, or a degree from 0 to 1" + found(*blocking));
    }
    if (const Form* const name = given.option("name")) {
      if (name->is_list() || name->kind == Form::Kind::kNumber || name->text.empty())
        fail(*name, "expected a name" + found(*name));
      intend->name = name->text;
    }
    if (const Form* const timeout = given.option("timeout"))
      intend->timeout = expression(*timeout, false);
    if (const Form* const priority = given.option("priority"))
      intend->priority = expression(*priority, false);
    step(at).text = "intends " + intend->schema;
    step(at).intend = std::move(intend);
    program_->mentions.push_back(std::move(mention));
    otherwise(at, given.option("else"));
    return true;
  }

  void arguments(const Form& form, Intend& intend, Mention& mention) {
    if (!form.is_list())
      fail(form, "expected the arguments: ((parameter . value) ...)" + found(form));
    std::set<std::string> names;
    for (const Form& item : form.items) {
      if (!item.is_list() || item.items.size() != 2 || item.items[0].is_list() ||
          item.items[0].kind == Form::Kind::kNumber) {
        complain(item, "expected (parameter . value)" + found(item));
        continue;
      }
      if (!names.insert(normal(item.items[0].text)).second)
        complain(item, "argument " + quoted(item.items[0].text) + " is given twice");
      intend.arguments.emplace_back(item.items[0].text, expression(item.items[1], false));
      mention.arguments.push_back(item.items[0].text);
      mention.lines.push_back(item.line);
      mention.columns.push_back(item.column);
      mention.argument_texts.push_back(reader_.trouble(item.line, 1, true, {}).line_text);
    }
  }

  bool branch(const Form& form) {
    const Parts given = parts(form, 1, {"else"});
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

  bool fork(const Form& form, Step::Op op) {
    const Parts given = op == Step::Op::kFork ? parts(form, 1, {"else"}) : parts(form, 1, {});
    if (given.items.empty())
      fail(form, "expected goals" + found(form));
    const std::size_t at = add(op, form);
    for (const Form* const each : given.items)
      add_branch(at, *each, form);
    step(at).target = here();
    otherwise(at, given.option("else"));
    return true;
  }

  void add_branch(std::size_t at, const Form& form, const Form& whole) {
    step(at).branches.push_back(here());
    try {
      goal_or_goals(form);
    } catch (const Stop&) {
    }
    add(Step::Op::kEndThread, whole);
  }

  bool guard(const Form& form, Step::Op op) {
    const bool maintains = op == Step::Op::kMaintain;
    const Parts given = maintains ? parts(form, 1, {"by", "else"}) : parts(form, 1, {"else"});
    if (given.items.size() < 2 || (maintains && given.option("by") == nullptr))
      fail(form, std::string("expected ") +
                     (maintains ? "(MAINTAIN condition :by goal goal ...)"
                                : "(PRESERVE condition goal ...)") +
                     found(form));
    const std::size_t at = add(op, form);
    take(at, *given.items[0], false);
    step(at).text = to_text(*given.items[0]);
    step(at).branches.push_back(here());
    sequence({given.items.begin() + 1, given.items.end()});
    add(Step::Op::kEndThread, form);
    if (maintains)
      add_branch(at, *given.option("by"), form);
    step(at).target = here();
    otherwise(at, given.option("else"));
    return true;
  }

  // --- expressions

  std::size_t slot(const Form& name) {
    const std::string key = normal(name.text);
    const auto found = slots_.find(key);
    if (found != slots_.end())
      return found->second;
    const std::size_t index = program_->locals.size();
    slots_[key] = index;
    program_->locals.push_back(name.text);
    return index;
  }

  Expression expression(const Form& form, bool actions) {
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
      fail(form, "expected (function ...)" + found(form));
    return call(form, normal(head.text), actions);
  }

  Expression variable(const Form& form) {
    Expression result;
    if (form.is("nil") || form.is("t")) {
      result.constant = literal(form);
      return result;
    }
    result.key = normal(form.text);
    result.name = form.text;
    const bool local = slots_.contains(result.key);
    if (starred(form.text) || (!local && functions_.condition(result.key) != nullptr)) {
      result.kind = Expression::Kind::kBelief;
      return result;
    }
    result.kind = Expression::Kind::kLocal;
    pending_.emplace(result.key, form);
    result.slot = slot(form);
    return result;
  }

  Expression call(const Form& form, const std::string& name, bool actions) {
    const Form& head = form.items[0];
    const std::size_t given = form.items.size() - 1;
    const auto expect = [&](std::size_t fewest, std::size_t most) {
      if (given < fewest || given > most)
        fail(form, "(" + head.text + ") expected " + count(fewest, most) + ", found " +
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
    // Of a name that is not computed: found without a call.
    if (name == "belief" && given == 1 &&
        (form.items[1].quoted || form.items[1].kind == Form::Kind::kText)) {
      result.kind = Kind::kBelief;
      const Value what = literal(form.items[1]);
      if (what.text() == nullptr)
        fail(form.items[1], "expected (belief 'name)" + found(form.items[1]));
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
      if (const Function* const function = functions_.function(name)) {
        expect(function->fewest, function->most);
        result.kind = Kind::kCall;
        result.function = shared(*function);
      } else if (const Action* const action = functions_.action(name)) {
        if (!actions)
          fail(head, quoted(head.text) + " is an action: expected it within EXECUTE");
        expect(action->fewest, action->most);
        result.kind = Kind::kAction;
        result.action = std::make_shared<const Action>(*action);
      } else {
        fail(head, "unknown function " + quoted(head.text));
      }
    }
    for (std::size_t i = 1; i < form.items.size(); ++i)
      result.arguments.push_back(expression(form.items[i], actions));
    return result;
  }

  Expression set(const Form& form, bool actions) {
    if (!actions)
      fail(form, "setq is an action: expected it within EXECUTE");
    if (form.items.size() != 3 || form.items[1].kind != Form::Kind::kName)
      fail(form, "expected (setq variable value)" + found(form));
    const Form& name = form.items[1];
    check_variable(name);
    Expression result;
    result.kind = Expression::Kind::kSet;
    result.name = name.text;
    result.key = normal(name.text);
    result.slot = kNowhere;
    if (!starred(name.text)) {
      result.slot = slot(name);
      assigned_.insert(result.key);
    }
    result.arguments.push_back(expression(form.items[2], actions));
    return result;
  }

  std::shared_ptr<const Function> shared(const Function& function) {
    auto& kept = kept_[function.name];
    if (!kept)
      kept = std::make_shared<const Function>(function);
    return kept;
  }

  Schema finish() {
    Schema schema;
    schema.name = program_->name;
    schema.summary = summary_;
    schema.parameters = parameters_;
    schema.source = program_->file;
    schema.concurrent = concurrent_;
    schema.priority = priority_;
    schema.timeout = program_->timeout;
    std::shared_ptr<const Program> program = std::move(program_);
    schema.program = program;
    schema.bind = [program](const Bindings& bindings) { return make_machine(program, bindings); };
    schema.make = [program](const Arguments& arguments) {
      Bindings bindings;
      for (const Argument& argument : arguments)
        bindings.emplace_back(argument.name, value_of(argument));
      return make_machine(program, bindings);
    };
    return schema;
  }

  const Reader& reader_;
  const Functions& functions_;
  std::vector<Diagnostic>& troubles_;
  std::size_t errors_ = 0;
  std::shared_ptr<Program> program_ = std::make_shared<Program>();
  std::vector<Parameter> parameters_;
  std::string summary_;
  int priority_ = 0;
  bool concurrent_ = false;
  std::size_t set_ = 0;
  std::map<std::string, std::size_t> labels_;
  std::vector<std::pair<std::size_t, Form>> gotos_;
  std::map<std::string, std::size_t> slots_;
  std::map<std::string, Form> pending_;  ///< locals by their first use
  std::set<std::string> assigned_;
  std::map<std::string, std::shared_ptr<const Function>> kept_;
};

/// What is wrong with one mention of a schema; nothing where it is right.
void check_mention(const Program& program, const Mention& mention, const Registry& registry,
                   std::vector<Diagnostic>& troubles, std::set<std::string>& told) {
  const auto trouble = [&](bool error, int line, int column, std::string message,
                           const std::string& text) {
    troubles.push_back({error, program.file, line, column, std::move(message), text});
  };
  std::vector<std::string> names;
  std::vector<std::string> required;
  if (const auto schema = registry.intended(mention.schema)) {
    for (const Parameter& parameter : schema->parameters) {
      names.push_back(parameter.name);
      if (parameter.required)
        required.push_back(parameter.name);
    }
  } else if (const BehaviorSignature* const behavior = registry.behavior(mention.schema)) {
    for (const Parameter& parameter : behavior->parameters) {
      names.push_back(parameter.name);
      if (parameter.required)
        required.push_back(parameter.name);
    }
  } else if (registry.knows_behaviors()) {
    trouble(true, mention.line, mention.column,
            "unknown schema " + quoted(mention.schema) + ": neither an activity nor a behavior",
            mention.line_text);
    return;
  } else {
    if (told.insert(normal(mention.schema)).second)
      trouble(false, mention.line, mention.column,
              quoted(mention.schema) +
                  " is no activity: whether it is a behavior is known when they are",
              mention.line_text);
    return;
  }
  std::string list;
  for (const std::string& name : names)
    list += (list.empty() ? "" : ", ") + name;
  for (std::size_t i = 0; i < mention.arguments.size(); ++i) {
    const bool known = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return normal(name) == normal(mention.arguments[i]);
    });
    if (!known)
      trouble(true, mention.lines[i], mention.columns[i],
              mention.schema + " has no parameter " + quoted(mention.arguments[i]) + ": expected " +
                  (list.empty() ? "none" : list),
              mention.argument_texts[i]);
  }
  for (const std::string& name : required) {
    const bool given =
        std::any_of(mention.arguments.begin(), mention.arguments.end(),
                    [&](const std::string& argument) { return normal(name) == normal(argument); });
    if (!given)
      trouble(true, mention.line, mention.column,
              mention.schema + " needs the parameter " + quoted(name), mention.line_text);
  }
}

}  // namespace

std::string Diagnostic::text() const {
  return FileError(file, line, column, (error ? "" : "warning: ") + message, line_text).what();
}

bool Loaded::ok() const {
  return std::none_of(troubles.begin(), troubles.end(),
                      [](const Diagnostic& trouble) { return trouble.error; });
}

Loaded load_activities(const std::vector<ActivityFile>& files, const Functions& functions,
                       const Registry& known) {
  struct Each {
    std::vector<Schema> schemas;
    std::vector<Diagnostic> troubles;
    bool broken() const {
      return std::any_of(troubles.begin(), troubles.end(),
                         [](const Diagnostic& trouble) { return trouble.error; });
    }
  };
  std::vector<Each> each(files.size());
  std::map<std::string, std::string> defined;
  for (std::size_t i = 0; i < files.size(); ++i) {
    Reader reader(files[i].name, files[i].content, each[i].troubles);
    for (const Form& form : reader.read()) {
      Compiler compiler(reader, functions, each[i].troubles);
      std::optional<Schema> schema = compiler.compile(form, files[i].name);
      if (!schema)
        continue;
      const auto [first, fresh] = defined.emplace(normal(schema->name), files[i].name);
      const Schema* const there = known.find(schema->name);
      if (!fresh)
        each[i].troubles.push_back(reader.trouble(
            form.line, form.column, true,
            "the activity " + quoted(schema->name) + " is in " + first->second + " already"));
      else if (there != nullptr && there->source.empty())
        each[i].troubles.push_back(reader.trouble(form.line, form.column, true,
                                                  quoted(schema->name) + " is built in already"));
      else
        each[i].schemas.push_back(std::move(*schema));
    }
  }
  // A file that names what a broken one has is not wrong for that: all names count. But a broken
  // file's own schemas are not there, so that the ones of an earlier version go on to count.
  Registry all = known;
  for (const Each& file : each) {
    for (const Schema& schema : file.schemas)
      all.add(schema);
  }
  Loaded loaded;
  for (Each& file : each) {
    std::set<std::string> told;
    for (const Schema& schema : file.schemas) {
      for (const Mention& mention : schema.program->mentions)
        check_mention(*schema.program, mention, all, file.troubles, told);
    }
    if (!file.broken())
      std::move(file.schemas.begin(), file.schemas.end(), std::back_inserter(loaded.schemas));
    std::stable_sort(file.troubles.begin(), file.troubles.end(),
                     [](const Diagnostic& a, const Diagnostic& b) {
                       return std::pair(a.line, a.column) < std::pair(b.line, b.column);
                     });
    std::move(file.troubles.begin(), file.troubles.end(), std::back_inserter(loaded.troubles));
  }
  return loaded;
}

Loaded load_text(const std::string& file, std::string_view content, const Functions& functions,
                 const Registry& known) {
  return load_activities({{file, std::string(content)}}, functions, known);
}

std::vector<Diagnostic> check_references(const Registry& registry) {
  std::vector<Diagnostic> troubles;
  std::set<std::string> told;
  for (const Schema* const schema : registry.all()) {
    if (!schema->program)
      continue;
    for (const Mention& mention : schema->program->mentions)
      check_mention(*schema->program, mention, registry, troubles, told);
  }
  return troubles;
}

}  // namespace saphira::intentions
