#include "language/program.hpp"
#include "saphira/intentions/beliefs.hpp"

namespace saphira::intentions {
namespace {

/// The arguments of a call; most calls have few.
class Evaluated {
 public:
  Evaluated(const std::vector<Expression>& arguments, Scope& scope) : count_(arguments.size()) {
    if (count_ > kFew)
      many_.resize(count_);
    Value* const to = begin();
    for (std::size_t i = 0; i < count_; ++i)
      to[i] = evaluate(arguments[i], scope);
  }
  Values values() { return {begin(), count_}; }

 private:
  static constexpr std::size_t kFew = 4;
  Value* begin() { return count_ > kFew ? many_.data() : few_; }

  std::size_t count_;
  Value few_[kFew];
  std::vector<Value> many_;
};

std::string name_given(const Expression& expression, Scope& scope) {
  const Value value = evaluate(expression.arguments.front(), scope);
  if (value.text() == nullptr)
    throw ActivityError("expected the name of an intention, got " + kind_of(value));
  return *value.text();
}

}  // namespace

Value evaluate(const Expression& expression, Scope& scope) {
  switch (expression.kind) {
    case Expression::Kind::kConstant:
      return expression.constant;
    case Expression::Kind::kLocal:
      return scope.locals[expression.slot];
    case Expression::Kind::kBelief:
      return scope.world.beliefs.get(expression.key, scope.world);
    case Expression::Kind::kCall: {
      Evaluated arguments(expression.arguments, scope);
      return expression.function->call(scope.world, arguments.values());
    }
    case Expression::Kind::kAction: {
      Evaluated arguments(expression.arguments, scope);
      return expression.action->call(scope.effects, arguments.values());
    }
    case Expression::Kind::kSet: {
      Value value = evaluate(expression.arguments.front(), scope);
      if (expression.slot != kNowhere)
        scope.locals[expression.slot] = value;
      else
        scope.effects.believe(expression.name, value);
      return value;
    }
    case Expression::Kind::kAnd: {
      Value value = Value::truth(true);
      for (const Expression& argument : expression.arguments) {
        value = evaluate(argument, scope);
        if (value.nil())
          return value;
      }
      return value;
    }
    case Expression::Kind::kOr:
      for (const Expression& argument : expression.arguments) {
        Value value = evaluate(argument, scope);
        if (value.truthy())
          return value;
      }
      return {};
    case Expression::Kind::kIf: {
      const std::size_t chosen = evaluate(expression.arguments[0], scope).truthy() ? 1 : 2;
      return chosen < expression.arguments.size() ? evaluate(expression.arguments[chosen], scope)
                                                  : Value();
    }
    case Expression::Kind::kStateOf:
      return scope.own.state_of(name_given(expression, scope));
    case Expression::Kind::kLevelOf:
      return Value(scope.own.level_of(name_given(expression, scope)));
    case Expression::Kind::kFinished: {
      const Value state = scope.own.state_of(name_given(expression, scope));
      const std::string* const text = state.text();
      return Value::truth(text == nullptr || *text == "success" || *text == "failure" ||
                          *text == "timeout");
    }
    case Expression::Kind::kOutcome:
      return Value(scope.own.outcome());
    case Expression::Kind::kReason:
      return Value(scope.own.reason());
    case Expression::Kind::kElapsed:
      return Value(scope.own.elapsed());
  }
  return {};
}

}  // namespace saphira::intentions
