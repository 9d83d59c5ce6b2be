#include "expressions.hpp"

namespace saphira::behaviors::language {
namespace {

class Compiler {
 public:
  Compiler(const ParsedBehavior& behavior, Messages& messages)
      : behavior_(behavior), messages_(messages) {}

  std::shared_ptr<const Program> compile() {
    const std::size_t errors = messages_.errors.size();
    program_->name = behavior_.name;
    for (const ParsedParameter& parameter : behavior_.parameters)
      bind(parameter);
    in_init_ = true;
    for (const Statement& one : behavior_.init)
      statement(one);
    in_init_ = false;
    code_.write_to(program_->update);
    for (const Statement& one : behavior_.update)
      statement(one);
    rules();
    activity();
    clear_implied();
    for (const auto& [name, variable] : variables_)
      if (!variable.used && !variable.parameter)
        messages_.warn(variable.place, "\"" + name + "\" is set and never used");
    if (code_.full())
      messages_.error(behavior_.place,
                      "expected a smaller behavior: there is no room for this one");
    return messages_.errors.size() == errors ? program_ : nullptr;
  }

 private:
  void error(const Place& place, const std::string& message) { messages_.error(place, message); }

  // Names ---------------------------------------------------------------------------------------

  void bind(const ParsedParameter& parameter) {
    Variable variable;
    variable.value.type = parameter.type;
    variable.value.at = code_.fresh(width(parameter.type));
    variable.place = parameter.place;
    variable.parameter = true;
    variable.spec = &parameter.spec;
    program_->parameters.push_back({variable.value.at, parameter.type, parameter.factor});
    const std::string& name = parameter.spec.name;
    if (reserved(name))
      error(parameter.place, "expected another name: \"" + name + "\" has a meaning already");
    else if (!variables_.emplace(name, variable).second)
      error(parameter.place, "the parameter \"" + name + "\" is there twice");
  }

  // Statements ----------------------------------------------------------------------------------

  void statement(const Statement& one) {
    if (messages_.full() || code_.full())
      return;
    switch (one.kind) {
      case Statement::Kind::block:
        for (const Statement& inner : one.body)
          statement(inner);
        return;
      case Statement::Kind::declare:
        declare(one);
        return;
      case Statement::Kind::assign:
        assign(one);
        return;
      case Statement::Kind::expression:
        expressions_.expression(*one.value);
        return;
      case Statement::Kind::choice:
        choice(one);
        return;
    }
  }

  void declare(const Statement& one) {
    Value from{code_.zero(), Type::integer};
    if (one.value)
      from = expressions_.expression(*one.value);
    if (reserved(one.name)) {
      error(one.place, "expected another name: \"" + one.name + "\" has a meaning already");
      return;
    }
    const auto before = variables_.find(one.name);
    if (before != variables_.end()) {
      error(one.place, "\"" + one.name + "\" is declared twice; before in line " +
                           std::to_string(before->second.place.line));
      return;
    }
    Variable variable;
    variable.value.type = one.type;
    variable.value.at = code_.fresh(width(one.type));
    variable.place = one.place;
    variable.kept = in_init_;
    variable.cleared = choices_ > 0;
    if (in_init_)
      program_->kept.push_back({one.name, one.type, variable.value.at});
    variables_.emplace(one.name, variable);
    if (one.type == Type::point && !one.value)
      for (int i = 0; i < 3; ++i)
        code_.emit(Op::move, static_cast<Register>(variable.value.at + i), code_.zero());
    else
      store(one.value ? one.value->place : one.place, from, variable.value);
  }

  void store(const Place& place, Value from, const Value& to) {
    if (from.type == Type::nothing) {
      error(place, "expected " + named(to.type) + "; this call gives nothing");
      return;
    }
    if ((is_number(from.type) != is_number(to.type)) ||
        (!is_number(from.type) && from.type != to.type)) {
      error(place, "expected " + named(to.type) + ", found " + named(from.type));
      return;
    }
    if (from.type == Type::real && to.type == Type::integer)
      from.at = code_.result(Op::truncate, from.at);
    code_.copy({from.at, to.type}, to.at);
  }

  void assign(const Statement& one) {
    const Value from = expressions_.expression(*one.value);
    if (one.name == "sfPreferredTurnDir") {
      const Place& place = one.value->place;
      if (expressions_.expect_number(place, from))
        code_.call(*find_function("sfSetPreferredTurn"), {{from.at, Type::integer}});
      return;
    }
    if (reserved(one.name)) {
      error(one.place, "\"" + one.name + "\" cannot be set");
      return;
    }
    auto found = variables_.find(one.name);
    if (found == variables_.end()) {
      // The fuzzy variables of the manual's example have no declaration.
      Variable variable;
      variable.value.at = code_.fresh();
      variable.place = one.place;
      variable.cleared = true;
      variable.kept = in_init_;
      if (in_init_)
        program_->kept.push_back({one.name, Type::real, variable.value.at});
      found = variables_.emplace(one.name, variable).first;
    } else if (found->second.parameter) {
      error(one.place, "\"" + one.name + "\" is a parameter: it cannot be set");
      return;
    }
    store(one.value->place, from, found->second.value);
  }

  void choice(const Statement& one) {
    const Value condition = expressions_.expression(*one.value);
    expressions_.expect_number(one.value->place, condition);
    const std::size_t to_else = code_.mark();
    code_.emit(Op::jump_unless, 0, condition.at);
    ++choices_;
    for (const Statement& inner : one.body)
      statement(inner);
    --choices_;
    if (one.otherwise.empty()) {
      code_.land(to_else);
      return;
    }
    const std::size_t to_end = code_.mark();
    code_.emit(Op::jump, 0);
    code_.land(to_else);
    ++choices_;
    for (const Statement& inner : one.otherwise)
      statement(inner);
    --choices_;
    code_.land(to_end);
  }

  /// Variables that an update may leave unset start as 0 in each update.
  void clear_implied() {
    std::vector<Instruction> clear;
    for (const auto& [name, variable] : variables_)
      if (variable.cleared && !variable.kept)
        for (std::size_t i = 0; i < width(variable.value.type); ++i)
          clear.push_back(
              {Op::move, static_cast<Register>(variable.value.at + i), code_.zero(), 0, 0});
    const auto shift = static_cast<std::uint16_t>(clear.size());
    for (Instruction& i : program_->update)
      if (i.op == Op::jump)
        i.a = static_cast<std::uint16_t>(i.a + shift);
      else if (i.op == Op::jump_unless)
        i.b = static_cast<std::uint16_t>(i.b + shift);
    program_->update.insert(program_->update.begin(), clear.begin(), clear.end());
  }

  // Rules and activity --------------------------------------------------------------------------

  void show(const std::string& name, Register at) {
    for (const Program::Shown& shown : program_->shown)
      if (shown.name == name)
        return;
    program_->shown.push_back({name, at});
  }

  Register named_number(const Place& place, const std::string& name, bool fuzzy) {
    const auto found = variables_.find(name);
    if (found == variables_.end())
      return expressions_.unknown(place, name).at;
    found->second.used = true;
    const Value& value = found->second.value;
    if (!is_number(value.type)) {
      error(place, "expected a number, and \"" + name + "\" is " + named(value.type));
      return code_.zero();
    }
    if (fuzzy && !found->second.parameter)
      show(name, value.at);
    return value.at;
  }

  Register fuzzy(const FuzzyExpression& e) {
    switch (e.kind) {
      case FuzzyExpression::Kind::number:
        return code_.constant(e.value);
      case FuzzyExpression::Kind::name:
        return named_number(e.place, e.name, true);
      case FuzzyExpression::Kind::invert:
        return code_.result(Op::subtract, code_.constant(1.0), fuzzy(e.parts[0]));
      case FuzzyExpression::Kind::both:
      case FuzzyExpression::Kind::either: {
        const Register a = fuzzy(e.parts[0]);
        const Register b = fuzzy(e.parts[1]);
        return code_.result(e.kind == FuzzyExpression::Kind::both ? Op::smallest : Op::largest, a,
                            b);
      }
    }
    return code_.zero();
  }

  Register rule_value(const RuleValue& value) {
    return value.name.empty() ? code_.constant(value.value)
                              : named_number(value.place, value.name, false);
  }

  void rules() {
    const RuleValue moderately{{}, {}, radians(10.0)};
    for (const ParsedRule& rule : behavior_.rules) {
      Program::RuleCode code;
      code.name = rule.name;
      code.kind = rule.kind;
      code.strength = fuzzy(rule.antecedent);
      if (rule.kind == ParsedRule::Kind::left || rule.kind == ParsedRule::Kind::right) {
        code.value = rule_value(rule.modifier.value_or(moderately));
      } else {
        code.value = rule_value(*rule.value);
        code.limited = rule.kind == ParsedRule::Kind::either && rule.modifier.has_value();
        if (code.limited)
          code.modifier = rule_value(*rule.modifier);
      }
      for (const Program::RuleCode& other : program_->rules)
        if (other.name == code.name)
          error(rule.place, "the rule \"" + code.name + "\" is there twice");
      program_->rules.push_back(std::move(code));
    }
  }

  void activity() {
    // A channel without an Activity statement is active where it has rules.
    bool turns = false;
    bool speeds = false;
    for (const Program::RuleCode& rule : program_->rules)
      (rule.kind <= ParsedRule::Kind::either ? turns : speeds) = true;
    program_->turn = code_.constant(turns ? 1.0 : 0.0);
    program_->speed = code_.constant(speeds ? 1.0 : 0.0);
    program_->goal = code_.zero();
    program_->progress = code_.zero();
    for (const ParsedActivity& activity : behavior_.activity) {
      const Register value = fuzzy(activity.value);
      (activity.channel == "Turn"    ? program_->turn
       : activity.channel == "Speed" ? program_->speed
       : activity.channel == "Goal"  ? program_->goal
                                     : program_->progress) = value;
    }
  }

  const ParsedBehavior& behavior_;
  Messages& messages_;
  std::shared_ptr<Program> program_ = std::make_shared<Program>();
  Assembler code_{*program_};
  Variables variables_;
  Expressions expressions_{code_, variables_, messages_, behavior_.lost};
  bool in_init_ = false;
  int choices_ = 0;  ///< that the statement is in
};

}  // namespace

std::shared_ptr<const Program> compile_behavior(const ParsedBehavior& behavior,
                                                Messages& messages) {
  return Compiler(behavior, messages).compile();
}

}  // namespace saphira::behaviors::language
