#pragma once

#include <algorithm>
#include <vector>

namespace saphira::test {

/// The value that a share of the values does not exceed: 0.5 gives the median, 1 the greatest; NaN
/// without values.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty())
    return std::nan("");
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace saphira::test
