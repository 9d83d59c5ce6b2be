#include "pixels.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/base/wide.hpp"

namespace saphira::sim {

namespace {

// Values between -1 and 1 on a unit lattice, linear between.
inline double lattice(double u, double v, std::uint32_t seed) {
  const std::int32_t fu = floor_of(u);
  const std::int32_t fv = floor_of(v);
  const auto iu = static_cast<std::uint32_t>(fu);
  const auto iv = static_cast<std::uint32_t>(fv);
  const auto value = [&](std::uint32_t i, std::uint32_t j) {
    return static_cast<std::int32_t>(hash(iu + i, iv + j, seed)) * 0x1p-31;
  };
  const double a = u - fu;
  const double b = v - fv;
  return (value(0, 0) * (1.0 - a) + value(1, 0) * a) * (1.0 - b) +
         (value(0, 1) * (1.0 - a) + value(1, 1) * a) * b;
}

// Functions of their own: the compiler takes many elements at a time only where it is told that the
// arrays do not overlap.

SAPHIRA_WIDE void add_texture(std::size_t count, const double* __restrict u,
                              const double* __restrict v, const double* __restrict fade,
                              const double* __restrict strength,
                              const std::uint32_t* __restrict seed, double* __restrict grey) {
  for (std::size_t i = 0; i < count; ++i)
    grey[i] += strength[i] * ((fade[i] * lattice(u[i], v[i], seed[i]) +
                               lattice(u[i] * 0.5, v[i] * 0.5, seed[i] + 977U) +
                               lattice(u[i] * 0.125, v[i] * 0.125, seed[i] + 3U * 977U)) /
                              1.6);
}

// The sum of two uniform draws of 16 bits is triangular.
SAPHIRA_WIDE void measure(std::size_t count, double gain, double noise,
                          const double* __restrict grey, const std::uint32_t* __restrict draws,
                          std::uint8_t* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto sum = static_cast<std::int32_t>((draws[i] & 0xFFFFU) + (draws[i] >> 16U));
    const double value = gain * grey[i] + noise * (sum / 65536.0 - 1.0);
    out[i] = static_cast<std::uint8_t>(std::clamp(floor_of(value + 0.5), 0, 255));
  }
}

}  // namespace

Detail Detail::of(double pixel) {
  const double level = std::max(0.0, std::log2(2.0 * pixel / 0.01));
  const int first = static_cast<int>(level);
  return {std::ldexp(100.0, -first), 1.0 - (level - first), static_cast<std::uint32_t>(first)};
}

Pixels::Pixels(std::size_t count)
    : grey_(count),
      strength_(count),
      u_(count),
      v_(count),
      fade_(count),
      seed_(count),
      draws_(count),
      values_(count) {}

const std::vector<std::uint8_t>& Pixels::expose(double gain, double noise, Random& random) {
  for (std::uint32_t& draw : draws_)
    draw = random.next();
  add_texture(grey_.size(), u_.data(), v_.data(), fade_.data(), strength_.data(), seed_.data(),
              grey_.data());
  measure(grey_.size(), gain, noise, grey_.data(), draws_.data(), values_.data());
  return values_;
}

}  // namespace saphira::sim
