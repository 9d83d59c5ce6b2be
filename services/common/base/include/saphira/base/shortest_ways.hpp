#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

namespace saphira {

/// Dijkstra's search over places that are numbered from 0. The caller knows the neighbours and the
/// costs of the steps: it takes the places from next(), nearest first, and adds steps from there
/// with reach(). Of places with the same cost the smaller number is first.
class ShortestWays {
 public:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  explicit ShortestWays(std::size_t places)
      : costs_(places, kNever), before_(places), settled_(places, false) {}

  /// The nearest place that was reached and not yet returned: its cost is final. None: no place is
  /// left.
  std::optional<std::size_t> next() {
    while (!open_.empty()) {
      const std::size_t place = open_.top().second;
      open_.pop();
      if (settled_[place])
        continue;
      settled_[place] = true;
      return place;
    }
    return std::nullopt;
  }
  /// A way to a place, by the place `before` it; none: the way begins there. `cost` is of the whole
  /// way. True where no cheaper way was known.
  bool reach(std::size_t place, double cost, std::optional<std::size_t> before = std::nullopt) {
    if (settled_[place] || cost >= costs_[place])
      return false;
    costs_[place] = cost;
    before_[place] = before;
    open_.emplace(cost, place);
    return true;
  }

  double cost(std::size_t place) const { return costs_[place]; }  ///< kNever: not reached
  bool settled(std::size_t place) const { return settled_[place]; }
  /// The places from the first one to this.
  std::vector<std::size_t> way_to(std::size_t place) const {
    std::vector<std::size_t> way;
    for (std::optional<std::size_t> at = place; at; at = before_[*at])
      way.push_back(*at);
    std::reverse(way.begin(), way.end());
    return way;
  }

 private:
  using Entry = std::pair<double, std::size_t>;

  std::vector<double> costs_;
  std::vector<std::optional<std::size_t>> before_;
  std::vector<bool> settled_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

}  // namespace saphira
