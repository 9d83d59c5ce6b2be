#include "expressions.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace saphira::behaviors::language {

Value Expressions::unknown(const Place& place, const std::string& name) {
  if (unknown_.insert(name).second)
    messages_.error(place, "unknown variable \"" + name.substr(0, 40) + "\"" +
                               meant_variable(name, variables_));
  return {code_.zero(), Type::real};
}

bool Expressions::expect_number(const Place& place, const Value& value) {
  if (is_number(value.type))
    return true;
  messages_.error(place, "expected a number, found " + named(value.type));
  return false;
}

Value Expressions::expression(const Expression& e) {
  switch (e.kind) {
    case Expression::Kind::number:
      return {code_.constant(e.value), e.whole ? Type::integer : Type::real};
    case Expression::Kind::text:
      messages_.error(e.place, "expected a number; a text can only be compared with a parameter");
      return {code_.zero(), Type::real};
    case Expression::Kind::name:
      return name(e);
    case Expression::Kind::field:
      return field(e);
    case Expression::Kind::call:
      return call(e);
    case Expression::Kind::negate:
    case Expression::Kind::invert:
    case Expression::Kind::cast:
      return unary(e);
    case Expression::Kind::binary:
      return binary(e);
    case Expression::Kind::conditional:
      return conditional(e);
  }
  return {};
}

Value Expressions::name(const Expression& e) {
  const auto found = variables_.find(e.text);
  if (found != variables_.end()) {
    found->second.used = true;
    if (found->second.value.type == Type::text)
      messages_.error(e.place,
                      "expected a number; \"" + e.text + "\" can only be compared with a text");
    return found->second.value;
  }
  if (e.text == "sfPreferredTurnDir")
    return code_.call(*find_function("sfPreferredTurn"), {});
  for (const Constant& known : constants())
    if (e.text == known.name)
      return {code_.constant(known.value),
              known.value == std::floor(known.value) ? Type::integer : Type::real};
  if (is_function(e.text)) {
    messages_.error(e.place, "expected \"(\" after the function \"" + e.text + "\"");
    return {code_.zero(), Type::real};
  }
  return unknown(e.place, e.text);
}

Value Expressions::field(const Expression& e) {
  const std::string& of = e.parts.front().text;
  const auto found = variables_.find(of);
  if (found == variables_.end() && of == "sfRobot") {
    for (const char* const known : {"tv", "rv", "mtv", "mrv", "ax", "ay", "ath"})
      if (e.text == known)
        return code_.call(*find_function("sfRobot." + e.text), {});
    messages_.error(e.place, "expected sfRobot.tv, .rv, .mtv, .mrv, .ax, .ay or .ath, found \"" +
                                 e.text + "\"");
    return {code_.zero(), Type::real};
  }
  if (found == variables_.end())
    return unknown(e.place, of);
  found->second.used = true;
  const Value& value = found->second.value;
  if (value.type != Type::point) {
    messages_.error(e.place,
                    "expected a point before \".\", and \"" + of + "\" is " + named(value.type));
    return {code_.zero(), Type::real};
  }
  for (int i = 0; i < 3; ++i)
    if (e.text == std::array{"x", "y", "th"}[static_cast<std::size_t>(i)])
      return {static_cast<Register>(value.at + i), Type::real};
  messages_.error(e.place, "expected the field x, y or th of a point, found \"" + e.text + "\"");
  return {code_.zero(), Type::real};
}

std::vector<Value> Expressions::arguments(const Expression& e, const std::vector<Type>& types) {
  std::vector<Value> values;
  if (e.parts.size() != types.size()) {
    messages_.error(e.place, "expected " + std::to_string(types.size()) + " argument" +
                                 (types.size() == 1 ? "" : "s") + " of " + e.text + ", found " +
                                 std::to_string(e.parts.size()));
    for (const Expression& part : e.parts)
      expression(part);
    return values;
  }
  for (std::size_t i = 0; i < types.size(); ++i) {
    const Value value = expression(e.parts[i]);
    const bool fits = types[i] == Type::point ? value.type == Type::point : is_number(value.type);
    if (!fits)
      messages_.error(e.parts[i].place, "argument " + std::to_string(i + 1) + " of " + e.text +
                                            ": expected " + named(types[i]) + ", found " +
                                            named(value.type));
    // Continues as after a valid one: the program is not used.
    values.push_back(fits ? value : Value{code_.fresh(3), types[i]});
  }
  return values;
}

Value Expressions::call(const Expression& e) {
  const std::string& name = e.text;
  if (const Quick* const quick = find_quick(name))
    return quick_call(e, *quick);
  if (name == "f_not") {
    const std::vector<Value> a = arguments(e, {Type::real});
    return a.empty() ? Value{code_.zero(), Type::real}
                     : Value{code_.result(Op::subtract, code_.constant(1.0), a[0].at), Type::real};
  }
  if (name == "f_greater" || name == "f_smaller" || name == "f_eq")
    return compared(e);
  if (const Function* const function = find_function(name)) {
    const std::vector<Value> a = arguments(e, function->arguments);
    if (a.size() != function->arguments.size())
      return {code_.fresh(3), function->result};
    return code_.call(*function, a);
  }
  for (const Expression& part : e.parts)
    expression(part);
  messages_.error(e.place,
                  "unknown function \"" + name.substr(0, 40) + "\"" + meant_function(name));
  return {code_.zero(), Type::real};
}

Value Expressions::quick_call(const Expression& e, const Quick& quick) {
  const std::vector<Value> a =
      arguments(e, std::vector<Type>(static_cast<std::size_t>(quick.arguments), Type::real));
  if (a.empty())
    return {code_.zero(), Type::real};
  const Register second = a.size() > 1 ? a[1].at : code_.zero();
  const Register third = a.size() > 2 ? a[2].at : code_.zero();
  const bool whole = quick.op != Op::up && quick.op != Op::down &&
                     std::ranges::all_of(a, [](const Value& v) { return v.type == Type::integer; });
  return {code_.result(quick.op, a[0].at, second, third), whole ? Type::integer : Type::real};
}

Value Expressions::compared(const Expression& e) {
  const std::vector<Value> a = arguments(e, {Type::real, Type::real, Type::real});
  if (a.empty())
    return {code_.zero(), Type::real};
  if (e.text == "f_eq") {
    const Register off = code_.result(Op::magnitude, code_.result(Op::subtract, a[0].at, a[1].at));
    return {code_.result(Op::down, off, code_.zero(), a[2].at), Type::real};
  }
  const Register half = code_.result(Op::multiply, a[2].at, code_.constant(0.5));
  const Register low = code_.result(Op::subtract, a[1].at, half);
  const Register high = code_.result(Op::add, a[1].at, half);
  return {code_.result(e.text == "f_greater" ? Op::up : Op::down, a[0].at, low, high), Type::real};
}

Value Expressions::unary(const Expression& e) {
  const Value value = expression(e.parts.front());
  if (!expect_number(e.parts.front().place, value))
    return {code_.zero(), Type::real};
  if (e.kind == Expression::Kind::negate)
    return {code_.result(Op::negate, value.at), value.type};
  if (e.kind == Expression::Kind::invert)
    return {code_.result(Op::invert, value.at), Type::integer};
  if (e.type == Type::integer && value.type == Type::real)
    return {code_.result(Op::truncate, value.at), Type::integer};
  return {value.at, e.type};
}

Value Expressions::binary(const Expression& e) {
  if (e.text == "&&" || e.text == "||")
    return logical(e);
  const Expression& left = e.parts[0];
  const Expression& right = e.parts[1];
  if (e.text == "==" || e.text == "!=")
    for (const bool swapped : {false, true})
      if ((swapped ? left : right).kind == Expression::Kind::text)
        return text_compared(e, swapped ? right : left, swapped ? left : right);
  const Value a = expression(left);
  const Value b = expression(right);
  if (!expect_number(left.place, a) || !expect_number(right.place, b))
    return {code_.zero(), Type::real};
  const bool whole = a.type == Type::integer && b.type == Type::integer;
  const Type type = whole ? Type::integer : Type::real;
  switch (e.text[0]) {
    case '+':
      return {code_.result(Op::add, a.at, b.at), type};
    case '-':
      return {code_.result(Op::subtract, a.at, b.at), type};
    case '*':
      return {code_.result(Op::multiply, a.at, b.at), type};
    case '/': {
      if (code_.is_zero(b.at))
        messages_.error(e.place, "expected another number to divide by than 0");
      const Register quotient = code_.result(Op::divide, a.at, b.at);
      return {whole ? code_.result(Op::truncate, quotient) : quotient, type};
    }
    case '%':
      return {code_.result(Op::remainder, a.at, b.at), type};
    case '=':
      return {code_.result(Op::equal, a.at, b.at), Type::integer};
    case '!':
      return {code_.result(Op::different, a.at, b.at), Type::integer};
    case '<':
      return {code_.result(e.text == "<" ? Op::less : Op::less_equal, a.at, b.at), Type::integer};
    default:
      return {code_.result(e.text == ">" ? Op::less : Op::less_equal, b.at, a.at), Type::integer};
  }
}

Value Expressions::text_compared(const Expression& e, const Expression& name,
                                 const Expression& text) {
  const auto found =
      name.kind == Expression::Kind::name ? variables_.find(name.text) : variables_.end();
  if (found == variables_.end() || found->second.value.type != Type::text) {
    messages_.error(name.place, "expected a parameter of type sfTEXT to compare a text with");
    return {code_.zero(), Type::integer};
  }
  found->second.used = true;
  const std::vector<std::string>& choices = found->second.spec->choices;
  const auto choice = std::find(choices.begin(), choices.end(), text.text);
  if (choice == choices.end()) {
    std::string expected;
    for (const std::string& one : choices)
      expected += (expected.empty() ? "\"" : " or \"") + one + "\"";
    messages_.error(text.place,
                    "expected " + expected + ", found \"" + text.text.substr(0, 40) + "\"");
    return {code_.zero(), Type::integer};
  }
  const Register index = code_.constant(static_cast<double>(choice - choices.begin()));
  return {code_.result(e.text == "==" ? Op::equal : Op::different, found->second.value.at, index),
          Type::integer};
}

Value Expressions::logical(const Expression& e) {
  const Register to = code_.fresh();
  const Value a = expression(e.parts[0]);
  expect_number(e.parts[0].place, a);
  const bool both = e.text == "&&";
  code_.emit(Op::truth, to, a.at);
  const Register undecided = both ? to : code_.fresh();
  if (!both)
    code_.emit(Op::invert, undecided, to);
  const std::size_t to_end = code_.mark();
  code_.emit(Op::jump_unless, 0, undecided);
  const Value b = expression(e.parts[1]);
  expect_number(e.parts[1].place, b);
  code_.emit(Op::truth, to, b.at);
  code_.land(to_end);
  return {to, Type::integer};
}

Value Expressions::conditional(const Expression& e) {
  const Value condition = expression(e.parts[0]);
  expect_number(e.parts[0].place, condition);
  const std::size_t to_else = code_.mark();
  code_.emit(Op::jump_unless, 0, condition.at);
  const Register to = code_.fresh(3);
  const Value yes = expression(e.parts[1]);
  code_.copy(yes, to);
  const std::size_t to_end = code_.mark();
  code_.emit(Op::jump, 0);
  code_.land(to_else);
  const Value no = expression(e.parts[2]);
  code_.copy(no, to);
  code_.land(to_end);
  if (is_number(yes.type) != is_number(no.type) || (!is_number(yes.type) && yes.type != no.type))
    messages_.error(e.parts[2].place,
                    "expected " + named(yes.type) + " as before \":\", found " + named(no.type));
  const Type type = is_number(yes.type) && yes.type != no.type ? Type::real : yes.type;
  return {to, type};
}

}  // namespace saphira::behaviors::language
