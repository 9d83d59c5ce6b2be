#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace saphira::registration {

/// Pieces [m] of a line, from and to.
using Stretches = std::vector<std::pair<double, double>>;

/// Sorted and without overlaps; gaps of up to `gap` are closed.
inline Stretches joined(Stretches stretches, double gap) {
  std::sort(stretches.begin(), stretches.end());
  Stretches out;
  for (const auto& s : stretches) {
    if (!out.empty() && s.first <= out.back().second + gap)
      out.back().second = std::max(out.back().second, s.second);
    else
      out.push_back(s);
  }
  return out;
}

/// The part that both have.
inline Stretches common(const Stretches& a, const Stretches& b) {
  Stretches out;
  for (const auto& x : a)
    for (const auto& y : b)
      if (std::min(x.second, y.second) > std::max(x.first, y.first))
        out.emplace_back(std::max(x.first, y.first), std::min(x.second, y.second));
  return joined(std::move(out), 0.0);
}

inline double total(const Stretches& stretches) {
  double sum = 0.0;
  for (const auto& s : stretches)
    sum += s.second - s.first;
  return sum;
}

}  // namespace saphira::registration
