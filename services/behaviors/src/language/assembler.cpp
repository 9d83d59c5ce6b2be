#include "assembler.hpp"

#include <algorithm>
#include <bit>

namespace saphira::behaviors::language {
namespace {

constexpr std::size_t kMostRegisters = 20000;
constexpr std::size_t kMostInstructions = 20000;

}  // namespace

bool Assembler::full() const {
  return program_.registers.size() > kMostRegisters ||
         program_.init.size() + program_.update.size() > kMostInstructions;
}

Register Assembler::fresh(std::size_t count) {
  if (full())
    return 0;
  const std::size_t at = program_.registers.size();
  program_.registers.resize(at + count, 0.0);
  return static_cast<Register>(at);
}

Register Assembler::constant(double value) {
  const auto key = std::bit_cast<std::uint64_t>(value);
  const auto known = constants_.find(key);
  if (known != constants_.end())
    return known->second;
  const Register at = fresh();
  program_.registers[at] = value;
  constants_.emplace(key, at);
  constant_registers_.insert(at);
  return at;
}

void Assembler::emit(Op op, Register to, Register a, Register b, Register c) {
  if (!full())
    code_->push_back({op, to, a, b, c});
}

Register Assembler::result(Op op, Register a, Register b, Register c) {
  if (is_constant(a) && is_constant(b) && is_constant(c)) {
    const std::vector<double>& r = program_.registers;
    return constant(apply(op, r[a], r[b], r[c]));
  }
  const Register to = fresh();
  emit(op, to, a, b, c);
  return to;
}

void Assembler::copy(const Value& from, Register to) {
  if (from.at != to)
    emit(from.type == Type::point ? Op::move3 : Op::move, to, from.at);
}

Value Assembler::call(const Function& function, const std::vector<Value>& arguments) {
  std::size_t wide = 0;
  for (const Type type : function.arguments)
    wide += width(type);
  Register at = fresh(std::max<std::size_t>(wide, 1));
  const Register first = at;
  for (const Value& argument : arguments) {
    copy(argument, at);
    at = static_cast<Register>(at + width(argument.type));
  }
  const Register to = fresh(width(function.result));
  auto& calls = program_.calls;
  const auto known = std::find(calls.begin(), calls.end(), function.call);
  const auto index = static_cast<Register>(known - calls.begin());
  if (known == calls.end())
    calls.push_back(function.call);
  emit(Op::call, to, first, index);
  return {to, function.result};
}

void Assembler::land(std::size_t where) {
  if (full())
    return;
  Instruction& jump = (*code_)[where];
  (jump.op == Op::jump ? jump.a : jump.b) = static_cast<std::uint16_t>(code_->size());
}

}  // namespace saphira::behaviors::language
