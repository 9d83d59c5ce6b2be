#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/idl/common.hpp"

namespace saphira {

inline Pose from_bus(const v1::Pose2& pose) {
  return {pose.x, pose.y, pose.th};
}

inline v1::Pose2 to_bus(const Pose& pose) {
  return {.x = pose.x, .y = pose.y, .th = pose.th};
}

/// The converted items, in their order: the first `most`, which is the bound of the sequence.
template <class Items, class Convert>
auto converted(const Items& items, Convert&& convert,
               std::size_t most = std::numeric_limits<std::size_t>::max()) {
  std::vector<decltype(convert(*items.begin()))> result;
  const std::size_t count = std::min<std::size_t>(items.size(), most);
  result.reserve(count);
  std::transform(items.begin(), std::next(items.begin(), static_cast<std::ptrdiff_t>(count)),
                 std::back_inserter(result), std::forward<Convert>(convert));
  return result;
}

/// As many as the bound of the sequence.
template <class T>
void shorten(std::vector<T>& items, std::size_t most) {
  items.resize(std::min(items.size(), most));
}

}  // namespace saphira
