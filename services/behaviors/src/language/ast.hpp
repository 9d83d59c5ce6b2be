#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lexer.hpp"
#include "saphira/behaviors/behavior.hpp"

// The syntax of a behavior, before names have a meaning.
namespace saphira::behaviors::language {

enum class Type { nothing, integer, real, point, text };

/// "a number", "a point": for messages.
std::string named(Type type);

struct Expression {
  enum class Kind { number, text, name, field, call, negate, invert, binary, conditional, cast };
  Kind kind = Kind::number;
  Place place;
  std::string text;  ///< name, field, function, operator
  double value = 0.0;
  bool whole = false;             ///< of a number
  Type type = Type::real;         ///< of a cast
  int depth = 1;                  ///< of the tree below
  std::vector<Expression> parts;  ///< operands and arguments
};

struct Statement {
  enum class Kind { declare, assign, expression, choice, block };
  Kind kind = Kind::block;
  Place place;
  Type type = Type::real;           ///< of a declaration
  std::string name;                 ///< the declared or assigned name
  std::optional<Expression> value;  ///< also the condition of a choice
  std::vector<Statement> body;      ///< of a block; of a choice: the taken branch
  std::vector<Statement> otherwise;
};

struct FuzzyExpression {
  enum class Kind { number, name, invert, both, either };
  Kind kind = Kind::number;
  Place place;
  std::string name;
  double value = 0.0;
  int depth = 1;
  std::vector<FuzzyExpression> parts;
};

/// A value of a rule's action: a name or a number.
struct RuleValue {
  Place place;
  std::string name;  ///< empty: a number
  double value = 0.0;
};

struct ParsedRule {
  Place place;
  std::string name;
  FuzzyExpression antecedent;
  std::string antecedent_text;
  std::string action_text;
  enum class Kind { left, right, either, speed, accelerate, decelerate } kind = Kind::speed;
  std::optional<RuleValue> value;  ///< of `either` and of the speeds
  std::optional<RuleValue> modifier;
};

struct ParsedActivity {
  Place place;
  std::string channel;
  FuzzyExpression value;
};

struct ParsedParameter {
  Place place;
  Type type = Type::real;
  ParameterSpec spec;
  double factor = 1.0;  ///< from the unit outside to that inside
};

struct ParsedBehavior {
  Place place;
  std::string name;
  std::string summary;
  std::vector<ParsedParameter> parameters;
  std::vector<ParsedRule> rules;
  std::vector<Statement> init;
  std::vector<Statement> update;
  std::vector<ParsedActivity> activity;
  /// Variables of unreadable sentences: their use is not another error.
  std::vector<std::string> lost;
};

/// Parses as much as possible; `messages` gets the errors.
std::vector<ParsedBehavior> parse(const std::vector<Token>& tokens, Messages& messages);

}  // namespace saphira::behaviors::language
