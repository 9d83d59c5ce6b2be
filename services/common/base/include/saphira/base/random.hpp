#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "saphira/base/archived.hpp"

namespace saphira {

/// A seeded generator with the same sequence on every machine and library (the distributions of
/// the standard library differ from one to another). PCG32, O'Neill 2014.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0) : increment_((stream << 1U) | 1U) {
    next();
    state_ += seed;
    next();
  }

  /// Uniform over all 32-bit values.
  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ULL + increment_;
    const auto mixed = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
    const auto turn = static_cast<std::uint32_t>(old >> 59U);
    return (mixed >> turn) | (mixed << ((32U - turn) & 31U));
  }

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next()) * 0x1p-32; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  bool chance(double probability) { return uniform() < probability; }

  /// Normal by Box and Muller; two uniforms a call, so that the sequence has no hidden state.
  double normal(double mean = 0.0, double deviation = 1.0) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return mean + deviation * radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

  SAPHIRA_ARCHIVE(state_, increment_)

 private:
  std::uint64_t state_ = 0;
  std::uint64_t increment_;
};

}  // namespace saphira
