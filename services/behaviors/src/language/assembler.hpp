#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "program.hpp"

namespace saphira::behaviors::language {

using Register = std::uint16_t;

/// A number in a register, or a point in three.
struct Value {
  Register at = 0;
  Type type = Type::real;
};

/// The number of registers of a type.
inline std::size_t width(Type type) {
  return type == Type::point ? 3 : 1;
}

/// Writes a program's instructions, and keeps its registers.
class Assembler {
 public:
  explicit Assembler(Program& program) : program_(program), code_(&program.init) {
    zero_ = constant(0.0);
  }

  /// Following instructions go there.
  void write_to(std::vector<Instruction>& code) { code_ = &code; }
  /// Beyond the limits the program is discarded in the end.
  bool full() const;

  Register fresh(std::size_t count = 1);
  Register constant(double value);
  Register zero() const { return zero_; }
  bool is_zero(Register at) const { return is_constant(at) && program_.registers[at] == 0.0; }

  void emit(Op op, Register to, Register a = 0, Register b = 0, Register c = 0);
  /// The result of a pure instruction: of constants another constant.
  Register result(Op op, Register a, Register b, Register c);
  Register result(Op op, Register a) { return result(op, a, zero_, zero_); }
  Register result(Op op, Register a, Register b) { return result(op, a, b, zero_); }
  void copy(const Value& from, Register to);
  /// A call of the language's function, with arguments of its types.
  Value call(const Function& function, const std::vector<Value>& arguments);

  std::size_t mark() const { return code_->size(); }
  /// Sets the target of the jump at `where` to here.
  void land(std::size_t where);

 private:
  bool is_constant(Register at) const { return constant_registers_.contains(at); }

  Program& program_;
  std::vector<Instruction>* code_;
  std::map<std::uint64_t, Register> constants_;  ///< by their bits
  std::set<Register> constant_registers_;
  Register zero_ = 0;
};

}  // namespace saphira::behaviors::language
