#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "ast.hpp"
#include "saphira/behaviors/behavior.hpp"

// A compiled behavior: straight code over a file of registers, each a double. Lengths are in mm and
// angles in radians in it, as in the manual.
namespace saphira::behaviors::language {

/// A way around an obstacle in front, see sfWay.
struct Way {
  double direction = 0.0;  ///< [rad]
  double cost = 1e9;       ///< [rad]
};

/// The view of the language's functions in one update.
struct Call {
  const Context* context = nullptr;
  Evaluation* evaluation = nullptr;
  /// The ways found so far: sfWay and sfWayCost of the same arguments search once.
  struct Known {
    double side = 0.0;
    double wish = 0.0;
    double reach = 0.0;
    Way way;
  };
  std::vector<Known> ways;
  /// The obstacles near the robot, collected on first use.
  std::vector<Vec2> near;
  double near_within = -1.0;  ///< [m]; negative: not yet collected
};

/// A function that Update and Init can call. A point takes three doubles: x, y, th.
struct Function {
  const char* name;
  Type result;
  std::vector<Type> arguments;
  void (*call)(Call&, const double* arguments, double* result);
};

const std::vector<Function>& functions();

/// A name that stands for a number.
struct Constant {
  const char* name;
  double value;
};
const std::vector<Constant>& constants();

enum class Op : std::uint16_t {
  move,
  move3,
  add,
  subtract,
  multiply,
  divide,
  remainder,
  negate,
  invert,
  truncate,
  less,
  less_equal,
  equal,
  different,
  truth,
  smallest,
  largest,
  magnitude,
  up,           ///< straight_up(a, b, c)
  down,         ///< down_straight(a, b, c)
  jump,         ///< to instruction a
  jump_unless,  ///< to instruction b where a is 0
  call          ///< the program's call b, arguments from a on
};

struct Instruction {
  Op op = Op::move;
  std::uint16_t to = 0;
  std::uint16_t a = 0;
  std::uint16_t b = 0;
  std::uint16_t c = 0;
};

inline double apply(Op op, double a, double b, double c) {
  switch (op) {
    case Op::add:
      return a + b;
    case Op::subtract:
      return a - b;
    case Op::multiply:
      return a * b;
    case Op::divide:
      // Always a number: NaN is reported where it reaches a rule.
      return b == 0.0 ? std::numeric_limits<double>::quiet_NaN() : a / b;
    case Op::remainder:
      return b == 0.0 ? std::numeric_limits<double>::quiet_NaN() : std::fmod(a, b);
    case Op::negate:
      return -a;
    case Op::invert:
      return a == 0.0 ? 1.0 : 0.0;
    case Op::truncate:
      return std::trunc(a);
    case Op::less:
      return a < b ? 1.0 : 0.0;
    case Op::less_equal:
      return a <= b ? 1.0 : 0.0;
    case Op::equal:
      return a == b ? 1.0 : 0.0;
    case Op::different:
      return a != b ? 1.0 : 0.0;
    case Op::truth:
      return a != 0.0 ? 1.0 : 0.0;
    case Op::smallest:
      return std::min(a, b);
    case Op::largest:
      return std::max(a, b);
    case Op::magnitude:
      return std::abs(a);
    case Op::up:
      return straight_up(a, b, c);
    case Op::down:
      return down_straight(a, b, c);
    default:
      return a;
  }
}

struct Program {
  struct Binding {
    std::uint16_t to = 0;
    Type type = Type::real;
    double factor = 1.0;
  };
  struct Kept {
    std::string name;
    Type type = Type::real;
    std::uint16_t at = 0;
  };
  struct RuleCode {
    std::string name;
    ParsedRule::Kind kind = ParsedRule::Kind::speed;
    std::uint16_t strength = 0;
    std::uint16_t value = 0;
    bool limited = false;  ///< of a turn by a variable: by `modifier`
    std::uint16_t modifier = 0;
  };
  struct Shown {
    std::string name;
    std::uint16_t at = 0;
  };

  std::string name;
  std::vector<Binding> parameters;  ///< in the order of the schema's
  std::vector<double> registers;    ///< constants; 0 elsewhere
  std::vector<Instruction> init;
  std::vector<Instruction> update;
  std::vector<void (*)(Call&, const double*, double*)> calls;  ///< indexed by b of Op::call
  std::vector<Kept> kept;                                      ///< the variables that persist
  std::vector<RuleCode> rules;
  std::vector<Shown> shown;
  std::uint16_t turn = 0;
  std::uint16_t speed = 0;
  std::uint16_t goal = 0;
  std::uint16_t progress = 0;
};

/// Gives a parsed behavior its meaning; nothing where that fails.
std::shared_ptr<const Program> compile_behavior(const ParsedBehavior& behavior, Messages& messages);

/// An instance that runs the program.
std::unique_ptr<Behavior> make_instance(std::shared_ptr<const Program> program);

}  // namespace saphira::behaviors::language
