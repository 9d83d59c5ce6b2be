#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <set>

#include "program.hpp"

namespace saphira::behaviors::language {
namespace {

constexpr std::size_t kMostRegisters = 20000;
constexpr std::size_t kMostInstructions = 20000;

using Register = std::uint16_t;

struct Value {
  Register at = 0;
  Type type = Type::real;
};

struct Variable {
  Value value;
  Place place;
  bool parameter = false;
  bool kept = false;     ///< of Init
  bool cleared = false;  ///< to be 0 at the beginning of each update
  bool used = false;
  const ParameterSpec* spec = nullptr;
};

bool number(Type type) {
  return type == Type::integer || type == Type::real;
}

/// Functions that are a single instruction.
struct Quick {
  const char* name;
  int arguments;
  Op op;
};
constexpr Quick kQuick[] = {
    {"straight_up", 3, Op::up},     {"up_straight", 3, Op::up}, {"down_straight", 3, Op::down},
    {"straight_down", 3, Op::down}, {"min", 2, Op::smallest},   {"max", 2, Op::largest},
    {"fmin", 2, Op::smallest},      {"fmax", 2, Op::largest},   {"f_and", 2, Op::smallest},
    {"f_or", 2, Op::largest},       {"abs", 1, Op::magnitude},  {"fabs", 1, Op::magnitude},
};

class Compiler {
 public:
  Compiler(const ParsedBehavior& behavior, Messages& messages)
      : behavior_(behavior), messages_(messages), program_(std::make_shared<Program>()) {}

  std::shared_ptr<const Program> compile() {
    const std::size_t errors = messages_.errors.size();
    program_->name = behavior_.name;
    zero_ = constant(0.0);
    unknown_.insert(behavior_.lost.begin(), behavior_.lost.end());
    for (const ParsedParameter& parameter : behavior_.parameters)
      bind(parameter);
    code_ = &program_->init;
    in_init_ = true;
    for (const Statement& one : behavior_.init)
      statement(one);
    in_init_ = false;
    code_ = &program_->update;
    for (const Statement& one : behavior_.update)
      statement(one);
    rules();
    activity();
    clear_implied();
    for (const auto& [name, variable] : variables_)
      if (!variable.used && !variable.parameter)
        messages_.warn(variable.place, "\"" + name + "\" is set and never used");
    if (full())
      messages_.error(behavior_.place,
                      "expected a smaller behavior: there is no room for this one");
    return messages_.errors.size() == errors ? program_ : nullptr;
  }

 private:
  void error(const Place& place, const std::string& message) { messages_.error(place, message); }

  bool full() const {
    return program_->registers.size() > kMostRegisters ||
           program_->init.size() + program_->update.size() > kMostInstructions;
  }

  // Registers -----------------------------------------------------------------------------------

  Register fresh(std::size_t count = 1) {
    // Beyond the limit the program is thrown away in the end.
    if (full())
      return 0;
    const std::size_t at = program_->registers.size();
    program_->registers.resize(at + count, 0.0);
    return static_cast<Register>(at);
  }

  Register constant(double value) {
    const auto key = std::bit_cast<std::uint64_t>(value);
    const auto known = constants_.find(key);
    if (known != constants_.end())
      return known->second;
    const Register at = fresh();
    program_->registers[at] = value;
    constants_.emplace(key, at);
    constant_registers_.insert(at);
    return at;
  }

  bool is_constant(Register at) const { return constant_registers_.contains(at); }

  void emit(Op op, Register to, Register a = 0, Register b = 0, Register c = 0) {
    if (!full())
      code_->push_back({op, to, a, b, c});
  }

  /// The result of a pure instruction: of constants another constant.
  Register result(Op op, Register a, Register b, Register c) {
    if (is_constant(a) && is_constant(b) && is_constant(c)) {
      const std::vector<double>& r = program_->registers;
      return constant(apply(op, r[a], r[b], r[c]));
    }
    const Register to = fresh();
    emit(op, to, a, b, c);
    return to;
  }
  Register result(Op op, Register a) { return result(op, a, zero_, zero_); }
  Register result(Op op, Register a, Register b) { return result(op, a, b, zero_); }

  void copy(const Value& from, Register to) {
    if (from.at != to)
      emit(from.type == Type::point ? Op::move3 : Op::move, to, from.at);
  }

  std::size_t mark() const { return code_->size(); }
  /// Makes the jump at `where` go to here.
  void land(std::size_t where) {
    if (full())
      return;
    Instruction& jump = (*code_)[where];
    (jump.op == Op::jump ? jump.a : jump.b) = static_cast<std::uint16_t>(code_->size());
  }

  // Names ---------------------------------------------------------------------------------------

  void bind(const ParsedParameter& parameter) {
    Variable variable;
    variable.value.type = parameter.type;
    variable.value.at = fresh(parameter.type == Type::point ? 3 : 1);
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

  static bool reserved(const std::string& name) {
    if (name == "sfPreferredTurnDir" || name == "sfRobot" || name == "f_greater" ||
        name == "f_smaller" || name == "f_eq" || name == "f_not")
      return true;
    return std::any_of(constants().begin(), constants().end(),
                       [&](const Constant& c) { return name == c.name; }) ||
           std::any_of(functions().begin(), functions().end(),
                       [&](const Function& f) { return name == f.name; }) ||
           std::any_of(std::begin(kQuick), std::end(kQuick),
                       [&](const Quick& q) { return name == q.name; });
  }

  /// ", did you mean ...?" where there is something like it.
  template <class Names>
  static std::string meant(const std::string& name, const Names& names) {
    std::string best;
    std::size_t least = std::min<std::size_t>(name.size() / 2 + 1, 4);
    for (const std::string& known : names) {
      const std::size_t d = distance(name, known);
      if (d < least) {
        least = d;
        best = known;
      }
    }
    return best.empty() ? "" : "; did you mean \"" + best + "\"?";
  }

  /// Levenshtein's, of names of people's length.
  static std::size_t distance(const std::string& a, const std::string& b) {
    if (a.size() > 40 || b.size() > 40)
      return 40;
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
      row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
      std::size_t corner = row[0];
      row[0] = i;
      for (std::size_t j = 1; j <= b.size(); ++j) {
        const std::size_t above = row[j];
        row[j] = std::min({above + 1, row[j - 1] + 1, corner + (a[i - 1] == b[j - 1] ? 0U : 1U)});
        corner = above;
      }
    }
    return row[b.size()];
  }

  std::vector<std::string> known_names() const {
    std::vector<std::string> names;
    for (const auto& [name, variable] : variables_)
      names.push_back(name);
    for (const Constant& constant : constants())
      names.emplace_back(constant.name);
    return names;
  }

  /// Says that there is no such variable, once a name, and goes on as if it were one.
  Value unknown(const Place& place, const std::string& name) {
    if (unknown_.insert(name).second)
      error(place, "unknown variable \"" + name.substr(0, 40) + "\"" + meant(name, known_names()));
    return {zero_, Type::real};
  }

  Value call_function(std::string_view name, const std::vector<Value>& arguments) {
    const std::vector<Function>& all = functions();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Function& f) { return f.name == name; });
    std::size_t width = 0;
    for (const Type type : found->arguments)
      width += type == Type::point ? 3 : 1;
    Register at = fresh(std::max<std::size_t>(width, 1));
    const Register first = at;
    for (const Value& argument : arguments) {
      copy(argument, at);
      at = static_cast<Register>(at + (argument.type == Type::point ? 3 : 1));
    }
    const Register to = fresh(found->result == Type::point ? 3 : 1);
    emit(Op::call, to, first, call_index(found->call));
    return {to, found->result};
  }

  Register call_index(void (*target)(Call&, const double*, double*)) {
    auto& calls = program_->calls;
    const auto known = std::find(calls.begin(), calls.end(), target);
    const auto index = static_cast<Register>(known - calls.begin());
    if (known == calls.end())
      calls.push_back(target);
    return index;
  }

  // Statements ----------------------------------------------------------------------------------

  void statement(const Statement& one) {
    if (messages_.full() || full())
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
        expression(*one.value);
        return;
      case Statement::Kind::choice:
        choice(one);
        return;
    }
  }

  void declare(const Statement& one) {
    Value from{zero_, Type::integer};
    if (one.value)
      from = expression(*one.value);
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
    variable.value.at = fresh(one.type == Type::point ? 3 : 1);
    variable.place = one.place;
    variable.kept = in_init_;
    variable.cleared = choices_ > 0;
    if (in_init_)
      program_->kept.push_back({one.name, one.type, variable.value.at});
    variables_.emplace(one.name, variable);
    if (one.type == Type::point && !one.value)
      for (int i = 0; i < 3; ++i)
        emit(Op::move, static_cast<Register>(variable.value.at + i), zero_);
    else
      store(one.value ? one.value->place : one.place, from, variable.value);
  }

  void store(const Place& place, Value from, const Value& to) {
    if (from.type == Type::nothing) {
      error(place, "expected " + named(to.type) + "; this call gives nothing");
      return;
    }
    if ((number(from.type) != number(to.type)) || (!number(from.type) && from.type != to.type)) {
      error(place, "expected " + named(to.type) + ", found " + named(from.type));
      return;
    }
    if (from.type == Type::real && to.type == Type::integer)
      from.at = result(Op::truncate, from.at);
    copy({from.at, to.type}, to.at);
  }

  void assign(const Statement& one) {
    const Value from = expression(*one.value);
    if (one.name == "sfPreferredTurnDir") {
      const Place& place = one.value->place;
      if (expect_number(place, from))
        call_function("sfSetPreferredTurn", {{from.at, Type::integer}});
      return;
    }
    if (reserved(one.name)) {
      error(one.place, "\"" + one.name + "\" cannot be set");
      return;
    }
    auto found = variables_.find(one.name);
    if (found == variables_.end()) {
      // The fuzzy variables of the manual's example: nobody declares them.
      Variable variable;
      variable.value.at = fresh();
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
    const Value condition = expression(*one.value);
    expect_number(one.value->place, condition);
    const std::size_t to_else = mark();
    emit(Op::jump_unless, 0, condition.at);
    ++choices_;
    for (const Statement& inner : one.body)
      statement(inner);
    --choices_;
    if (one.otherwise.empty()) {
      land(to_else);
      return;
    }
    const std::size_t to_end = mark();
    emit(Op::jump, 0);
    land(to_else);
    ++choices_;
    for (const Statement& inner : one.otherwise)
      statement(inner);
    --choices_;
    land(to_end);
  }

  /// Variables that an update may leave alone begin each one as 0.
  void clear_implied() {
    std::vector<Instruction> clear;
    for (const auto& [name, variable] : variables_)
      if (variable.cleared && !variable.kept)
        for (int i = 0; i < (variable.value.type == Type::point ? 3 : 1); ++i)
          clear.push_back({Op::move, static_cast<Register>(variable.value.at + i), zero_, 0, 0});
    const auto shift = static_cast<std::uint16_t>(clear.size());
    for (Instruction& i : program_->update)
      if (i.op == Op::jump)
        i.a = static_cast<std::uint16_t>(i.a + shift);
      else if (i.op == Op::jump_unless)
        i.b = static_cast<std::uint16_t>(i.b + shift);
    program_->update.insert(program_->update.begin(), clear.begin(), clear.end());
  }

  // Expressions ---------------------------------------------------------------------------------

  bool expect_number(const Place& place, const Value& value) {
    if (number(value.type))
      return true;
    error(place, "expected a number, found " + named(value.type));
    return false;
  }

  Value expression(const Expression& e) {
    switch (e.kind) {
      case Expression::Kind::number:
        return {constant(e.value), e.whole ? Type::integer : Type::real};
      case Expression::Kind::text:
        error(e.place, "expected a number; a text can only be compared with a parameter");
        return {zero_, Type::real};
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

  Value name(const Expression& e) {
    const auto found = variables_.find(e.text);
    if (found != variables_.end()) {
      found->second.used = true;
      if (found->second.value.type == Type::text)
        error(e.place, "expected a number; \"" + e.text + "\" can only be compared with a text");
      return found->second.value;
    }
    if (e.text == "sfPreferredTurnDir")
      return call_function("sfPreferredTurn", {});
    for (const Constant& known : constants())
      if (e.text == known.name)
        return {constant(known.value),
                known.value == std::floor(known.value) ? Type::integer : Type::real};
    if (is_function(e.text)) {
      error(e.place, "expected \"(\" after the function \"" + e.text + "\"");
      return {zero_, Type::real};
    }
    return unknown(e.place, e.text);
  }

  static bool is_function(const std::string& name) {
    return reserved(name) && name != "sfPreferredTurnDir" && name != "sfRobot" &&
           std::none_of(constants().begin(), constants().end(),
                        [&](const Constant& c) { return name == c.name; });
  }

  Value field(const Expression& e) {
    const std::string& of = e.parts.front().text;
    const auto found = variables_.find(of);
    if (found == variables_.end() && of == "sfRobot") {
      for (const char* const known : {"tv", "rv", "mtv", "mrv", "ax", "ay", "ath"})
        if (e.text == known)
          return call_function("sfRobot." + e.text, {});
      error(e.place,
            "expected sfRobot.tv, .rv, .mtv, .mrv, .ax, .ay or .ath, found \"" + e.text + "\"");
      return {zero_, Type::real};
    }
    if (found == variables_.end())
      return unknown(e.place, of);
    found->second.used = true;
    const Value& value = found->second.value;
    if (value.type != Type::point) {
      error(e.place, "expected a point before \".\", and \"" + of + "\" is " + named(value.type));
      return {zero_, Type::real};
    }
    for (int i = 0; i < 3; ++i)
      if (e.text == std::array{"x", "y", "th"}[static_cast<std::size_t>(i)])
        return {static_cast<Register>(value.at + i), Type::real};
    error(e.place, "expected the field x, y or th of a point, found \"" + e.text + "\"");
    return {zero_, Type::real};
  }

  std::vector<Value> arguments(const Expression& e, const std::vector<Type>& types) {
    std::vector<Value> values;
    if (e.parts.size() != types.size()) {
      error(e.place, "expected " + std::to_string(types.size()) + " argument" +
                         (types.size() == 1 ? "" : "s") + " of " + e.text + ", found " +
                         std::to_string(e.parts.size()));
      for (const Expression& part : e.parts)
        expression(part);
      return values;
    }
    for (std::size_t i = 0; i < types.size(); ++i) {
      const Value value = expression(e.parts[i]);
      const bool fits = types[i] == Type::point ? value.type == Type::point : number(value.type);
      if (!fits)
        error(e.parts[i].place, "argument " + std::to_string(i + 1) + " of " + e.text +
                                    ": expected " + named(types[i]) + ", found " +
                                    named(value.type));
      // As if it had been right: the program is not used.
      values.push_back(fits ? value : Value{fresh(3), types[i]});
    }
    return values;
  }

  Value call(const Expression& e) {
    const std::string& name = e.text;
    for (const Quick& quick : kQuick)
      if (name == quick.name) {
        const std::vector<Value> a =
            arguments(e, std::vector<Type>(static_cast<std::size_t>(quick.arguments), Type::real));
        if (a.empty())
          return {zero_, Type::real};
        const Register second = a.size() > 1 ? a[1].at : zero_;
        const Register third = a.size() > 2 ? a[2].at : zero_;
        const bool whole =
            quick.op != Op::up && quick.op != Op::down &&
            std::all_of(a.begin(), a.end(), [](const Value& v) { return v.type == Type::integer; });
        return {result(quick.op, a[0].at, second, third), whole ? Type::integer : Type::real};
      }
    if (name == "f_not") {
      const std::vector<Value> a = arguments(e, {Type::real});
      return a.empty() ? Value{zero_, Type::real}
                       : Value{result(Op::subtract, constant(1.0), a[0].at), Type::real};
    }
    if (name == "f_greater" || name == "f_smaller" || name == "f_eq")
      return compared(e);
    for (const Function& function : functions())
      if (name == function.name) {
        const std::vector<Value> a = arguments(e, function.arguments);
        if (a.size() != function.arguments.size())
          return {fresh(3), function.result};
        return call_function(name, a);
      }
    for (const Expression& part : e.parts)
      expression(part);
    std::vector<std::string> names;
    for (const Function& function : functions())
      names.emplace_back(function.name);
    for (const Quick& quick : kQuick)
      names.emplace_back(quick.name);
    for (const char* const more : {"f_greater", "f_smaller", "f_eq", "f_not"})
      names.emplace_back(more);
    error(e.place, "unknown function \"" + name.substr(0, 40) + "\"" + meant(name, names));
    return {zero_, Type::real};
  }

  /// f_greater, f_smaller and f_eq, as fuzzy.hpp has them.
  Value compared(const Expression& e) {
    const std::vector<Value> a = arguments(e, {Type::real, Type::real, Type::real});
    if (a.empty())
      return {zero_, Type::real};
    if (e.text == "f_eq") {
      const Register off = result(Op::magnitude, result(Op::subtract, a[0].at, a[1].at));
      return {result(Op::down, off, zero_, a[2].at), Type::real};
    }
    const Register half = result(Op::multiply, a[2].at, constant(0.5));
    const Register low = result(Op::subtract, a[1].at, half);
    const Register high = result(Op::add, a[1].at, half);
    return {result(e.text == "f_greater" ? Op::up : Op::down, a[0].at, low, high), Type::real};
  }

  Value unary(const Expression& e) {
    const Value value = expression(e.parts.front());
    if (!expect_number(e.parts.front().place, value))
      return {zero_, Type::real};
    if (e.kind == Expression::Kind::negate)
      return {result(Op::negate, value.at), value.type};
    if (e.kind == Expression::Kind::invert)
      return {result(Op::invert, value.at), Type::integer};
    if (e.type == Type::integer && value.type == Type::real)
      return {result(Op::truncate, value.at), Type::integer};
    return {value.at, e.type};
  }

  Value binary(const Expression& e) {
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
      return {zero_, Type::real};
    const bool whole = a.type == Type::integer && b.type == Type::integer;
    const Type type = whole ? Type::integer : Type::real;
    switch (e.text[0]) {
      case '+':
        return {result(Op::add, a.at, b.at), type};
      case '-':
        return {result(Op::subtract, a.at, b.at), type};
      case '*':
        return {result(Op::multiply, a.at, b.at), type};
      case '/': {
        if (is_constant(b.at) && program_->registers[b.at] == 0.0)
          error(e.place, "expected another number to divide by than 0");
        const Register quotient = result(Op::divide, a.at, b.at);
        return {whole ? result(Op::truncate, quotient) : quotient, type};
      }
      case '%':
        return {result(Op::remainder, a.at, b.at), type};
      case '=':
        return {result(Op::equal, a.at, b.at), Type::integer};
      case '!':
        return {result(Op::different, a.at, b.at), Type::integer};
      case '<':
        return {result(e.text == "<" ? Op::less : Op::less_equal, a.at, b.at), Type::integer};
      default:
        return {result(e.text == ">" ? Op::less : Op::less_equal, b.at, a.at), Type::integer};
    }
  }

  Value text_compared(const Expression& e, const Expression& name, const Expression& text) {
    const auto found =
        name.kind == Expression::Kind::name ? variables_.find(name.text) : variables_.end();
    if (found == variables_.end() || found->second.value.type != Type::text) {
      error(name.place, "expected a parameter of type sfTEXT to compare a text with");
      return {zero_, Type::integer};
    }
    found->second.used = true;
    const std::vector<std::string>& choices = found->second.spec->choices;
    const auto choice = std::find(choices.begin(), choices.end(), text.text);
    if (choice == choices.end()) {
      std::string expected;
      for (const std::string& one : choices)
        expected += (expected.empty() ? "\"" : " or \"") + one + "\"";
      error(text.place, "expected " + expected + ", found \"" + text.text.substr(0, 40) + "\"");
      return {zero_, Type::integer};
    }
    const Register index = constant(static_cast<double>(choice - choices.begin()));
    return {result(e.text == "==" ? Op::equal : Op::different, found->second.value.at, index),
            Type::integer};
  }

  /// && and ||: the right side is not looked at where the left one decides.
  Value logical(const Expression& e) {
    const Register to = fresh();
    const Value a = expression(e.parts[0]);
    expect_number(e.parts[0].place, a);
    const bool both = e.text == "&&";
    emit(Op::truth, to, a.at);
    const Register undecided = both ? to : fresh();
    if (!both)
      emit(Op::invert, undecided, to);
    const std::size_t to_end = mark();
    emit(Op::jump_unless, 0, undecided);
    const Value b = expression(e.parts[1]);
    expect_number(e.parts[1].place, b);
    emit(Op::truth, to, b.at);
    land(to_end);
    return {to, Type::integer};
  }

  Value conditional(const Expression& e) {
    const Value condition = expression(e.parts[0]);
    expect_number(e.parts[0].place, condition);
    const std::size_t to_else = mark();
    emit(Op::jump_unless, 0, condition.at);
    const Register to = fresh(3);
    const Value yes = expression(e.parts[1]);
    copy(yes, to);
    const std::size_t to_end = mark();
    emit(Op::jump, 0);
    land(to_else);
    const Value no = expression(e.parts[2]);
    copy(no, to);
    land(to_end);
    if (number(yes.type) != number(no.type) || (!number(yes.type) && yes.type != no.type))
      error(e.parts[2].place,
            "expected " + named(yes.type) + " as before \":\", found " + named(no.type));
    const Type type = number(yes.type) && yes.type != no.type ? Type::real : yes.type;
    return {to, type};
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
      return unknown(place, name).at;
    found->second.used = true;
    const Value& value = found->second.value;
    if (!number(value.type)) {
      error(place, "expected a number, and \"" + name + "\" is " + named(value.type));
      return zero_;
    }
    if (fuzzy && !found->second.parameter)
      show(name, value.at);
    return value.at;
  }

  Register fuzzy(const FuzzyExpression& e) {
    switch (e.kind) {
      case FuzzyExpression::Kind::number:
        return constant(e.value);
      case FuzzyExpression::Kind::name:
        return named_number(e.place, e.name, true);
      case FuzzyExpression::Kind::invert:
        return result(Op::subtract, constant(1.0), fuzzy(e.parts[0]));
      case FuzzyExpression::Kind::both:
      case FuzzyExpression::Kind::either: {
        const Register a = fuzzy(e.parts[0]);
        const Register b = fuzzy(e.parts[1]);
        return result(e.kind == FuzzyExpression::Kind::both ? Op::smallest : Op::largest, a, b);
      }
    }
    return zero_;
  }

  Register rule_value(const RuleValue& value) {
    return value.name.empty() ? constant(value.value)
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
    // A channel of which nothing is said is active where there are rules for it.
    bool turns = false;
    bool speeds = false;
    for (const Program::RuleCode& rule : program_->rules)
      (rule.kind <= ParsedRule::Kind::either ? turns : speeds) = true;
    program_->turn = constant(turns ? 1.0 : 0.0);
    program_->speed = constant(speeds ? 1.0 : 0.0);
    program_->goal = zero_;
    program_->progress = zero_;
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
  std::shared_ptr<Program> program_;
  std::vector<Instruction>* code_ = nullptr;
  bool in_init_ = false;
  int choices_ = 0;  ///< that the statement is in
  Register zero_ = 0;
  std::map<std::string, Variable> variables_;
  std::map<std::uint64_t, Register> constants_;
  std::set<Register> constant_registers_;
  std::set<std::string> unknown_;
};

}  // namespace

std::shared_ptr<const Program> compile_behavior(const ParsedBehavior& behavior,
                                                Messages& messages) {
  return Compiler(behavior, messages).compile();
}

}  // namespace saphira::behaviors::language
