#pragma once

#include <algorithm>
#include <cmath>

// Fuzzy variables of manual 7.5: numbers in [0, 1], with max for "or", min for "and".
namespace saphira::behaviors {

using Fuzzy = double;

/// 0 below `low`, 1 above `high`, linear between (manual Figure 7-1). With low == high a step.
inline Fuzzy straight_up(double x, double low, double high) {
  if (x >= high)
    return 1.0;
  if (x <= low)
    return 0.0;
  return (x - low) / (high - low);
}

/// 1 below `low`, 0 above `high`.
inline Fuzzy down_straight(double x, double low, double high) {
  return 1.0 - straight_up(x, low, high);
}

// The manual defines `delta` of f_greater, f_smaller and f_eq as "the range over which the fuzzy
// value will vary". Here that range is centred on `c` for the first two, so that f_greater is the
// negation of f_smaller and both are one half at equality; f_eq is 1 at `c` and 0 from `delta` off.

inline Fuzzy f_greater(double x, double c, double delta) {
  return straight_up(x, c - delta / 2.0, c + delta / 2.0);
}

inline Fuzzy f_smaller(double x, double c, double delta) {
  return 1.0 - f_greater(x, c, delta);
}

inline Fuzzy f_eq(double x, double c, double delta) {
  return down_straight(std::abs(x - c), 0.0, delta);
}

inline Fuzzy f_not(Fuzzy x) {
  return 1.0 - x;
}

template <class... More>
Fuzzy f_and(Fuzzy x, More... more) {
  return std::min({x, static_cast<Fuzzy>(more)...});
}

template <class... More>
Fuzzy f_or(Fuzzy x, More... more) {
  return std::max({x, static_cast<Fuzzy>(more)...});
}

}  // namespace saphira::behaviors
