#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "saphira/registration/feature_graph.hpp"

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

/// The seen stretches of lines along the x axis of a frame in the map: those that fit, by their
/// middle in that frame.
template <typename Fits>
Stretches seen_along(const Pose& frame, const FeatureGraph& graph, std::span<const GraphLine> lines,
                     const Fits& fits) {
  Stretches out;
  for (const GraphLine& line : lines)
    for (const SeenLine& seen : line.seen) {
      const Pose in = relative(frame, compose(graph.nodes[seen.node].in_map, seen.in_node));
      if (fits(in))
        out.emplace_back(in.x - seen.length / 2, in.x + seen.length / 2);
    }
  return joined(std::move(out), 0.1);
}

/// All those of one line.
inline Stretches seen_along(const Pose& frame, const FeatureGraph& graph, const GraphLine& line) {
  return seen_along(frame, graph, {&line, 1}, [](const Pose& /*in*/) { return true; });
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
