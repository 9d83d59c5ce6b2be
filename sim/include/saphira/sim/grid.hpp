#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::sim {

/// Which of many moving things are near a place, at the cost of those that are near: their numbers,
/// cell by cell of a uniform grid. Answers come in ascending order, so that a result does not
/// depend on who moved where when.
class Grid {
 public:
  /// Of a world of that size [m]; what is outside counts to the cells at its border.
  Grid(double width, double height);

  /// Puts a number, counting from 0, to where it is now.
  void put(std::uint32_t number, const Vec2& at);

  /// Every number within `reach` [m] of `point`, and some that are not; ascending. Valid until the
  /// next call.
  const std::vector<std::uint32_t>& near(const Vec2& point, double reach) const;

 private:
  std::size_t column(double x) const;
  std::size_t row(double y) const;

  std::size_t columns_;
  std::size_t rows_;
  std::vector<std::vector<std::uint32_t>> cells_;
  std::vector<std::size_t> cell_of_;  // by number
  mutable std::vector<std::uint32_t> found_;
};

}  // namespace saphira::sim
