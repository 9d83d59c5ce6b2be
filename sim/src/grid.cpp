#include "saphira/sim/grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace saphira::sim {

namespace {

// Sonars have a range of 5 m: smaller cells would outnumber the things in them.
constexpr double kCell = 4.0;            // [m]
constexpr std::size_t kMostCells = 512;  // in a row; a larger world adds its rest to the last one

constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();

std::size_t cells(double length) {
  return static_cast<std::size_t>(std::clamp(std::ceil(length / kCell), 1.0, double{kMostCells}));
}

std::size_t index(double at, std::size_t count) {
  return static_cast<std::size_t>(
      std::clamp(std::floor(at / kCell), 0.0, static_cast<double>(count - 1)));
}

}  // namespace

Grid::Grid(double width, double height)
    : columns_(cells(width)), rows_(cells(height)), cells_(columns_ * rows_) {}

std::size_t Grid::column(double x) const {
  return index(x, columns_);
}

std::size_t Grid::row(double y) const {
  return index(y, rows_);
}

void Grid::put(std::uint32_t number, const Vec2& at) {
  if (number >= cell_of_.size())
    cell_of_.resize(number + 1, kNowhere);
  const std::size_t cell = row(at.y()) * columns_ + column(at.x());
  if (cell_of_[number] == cell)
    return;
  if (cell_of_[number] != kNowhere)
    std::erase(cells_[cell_of_[number]], number);
  cells_[cell].push_back(number);
  cell_of_[number] = cell;
}

const std::vector<std::uint32_t>& Grid::near(const Vec2& point, double reach) const {
  found_.clear();
  if (cell_of_.empty())
    return found_;
  const std::size_t left = column(point.x() - reach);
  const std::size_t right = column(point.x() + reach);
  const std::size_t top = row(point.y() + reach);
  for (std::size_t y = row(point.y() - reach); y <= top; ++y)
    for (std::size_t x = left; x <= right; ++x) {
      const auto& cell = cells_[y * columns_ + x];
      found_.insert(found_.end(), cell.begin(), cell.end());
    }
  std::ranges::sort(found_);
  return found_;
}

}  // namespace saphira::sim
