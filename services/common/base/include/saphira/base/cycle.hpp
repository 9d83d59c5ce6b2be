#pragma once

namespace saphira {

/// [s] from one cycle of the system to the next (manual 2.1.1).
inline constexpr double kCycle = 0.1;

/// [s] The time of that many cycles, an unsigned or signed number.
template <class Cycles>
constexpr double seconds_of(Cycles cycles) {
  return kCycle * static_cast<double>(cycles);
}

}  // namespace saphira
