#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace saphira::vision {

/// Of at least one value; their order changes.
inline double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace saphira::vision
