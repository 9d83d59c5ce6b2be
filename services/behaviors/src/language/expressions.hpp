#pragma once

#include <set>
#include <string>
#include <vector>

#include "names.hpp"

namespace saphira::behaviors::language {

inline bool is_number(Type type) {
  return type == Type::integer || type == Type::real;
}

/// Compiles the expressions of Init and Update. After an error it continues as if there were none.
class Expressions {
 public:
  /// `lost`: names that are known to be missing.
  Expressions(Assembler& code, Variables& variables, Messages& messages,
              const std::vector<std::string>& lost)
      : code_(code),
        variables_(variables),
        messages_(messages),
        unknown_(lost.begin(), lost.end()) {}

  Value expression(const Expression& e);
  bool expect_number(const Place& place, const Value& value);
  /// Reports an unknown variable, once for each name, and continues as if it existed.
  Value unknown(const Place& place, const std::string& name);

 private:
  Value name(const Expression& e);
  Value field(const Expression& e);
  std::vector<Value> arguments(const Expression& e, const std::vector<Type>& types);
  Value call(const Expression& e);
  Value quick_call(const Expression& e, const Quick& quick);
  /// f_greater, f_smaller and f_eq, as fuzzy.hpp has them.
  Value compared(const Expression& e);
  Value unary(const Expression& e);
  Value binary(const Expression& e);
  Value text_compared(const Expression& e, const Expression& name, const Expression& text);
  /// && and
  /// : the right side is not evaluated where the left one decides.
  Value logical(const Expression& e);
  Value conditional(const Expression& e);

  Assembler& code_;
  Variables& variables_;
  Messages& messages_;
  std::set<std::string> unknown_;
};

}  // namespace saphira::behaviors::language
