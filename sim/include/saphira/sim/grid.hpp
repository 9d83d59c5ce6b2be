#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::sim {

/// Finds the moving objects near a place, at the cost of the near ones: their numbers, cell by cell
/// of a uniform grid. Results are in ascending order, so that they do not depend on the order of
/// motion.
class Grid {
 public:
  /// Of a world of that size [m]; places outside belong to the cells at its border.
  Grid(double width, double height);

  /// Puts a number, counting from 0, at its present place.
  void put(std::uint32_t number, const Vec2& at);

  /// Every number within `reach` [m] of `point`, and some beyond; ascending. Valid until the next
  /// call.
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
