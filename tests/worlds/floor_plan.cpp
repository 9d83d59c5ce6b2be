#include "floor_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace saphira::test {

std::string source(const std::string& path) {
  const char* root = std::getenv("SAPHIRA_SOURCE_DIR");
  return std::string(root == nullptr ? SAPHIRA_TESTED_SOURCE : root) + "/" + path;
}

Reach::Reach(const sim::World& world, double radius)
    : columns_(static_cast<int>(std::ceil(world.width / kCell))),
      rows_(static_cast<int>(std::ceil(world.height / kCell))),
      cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), Cell::kFree) {
  for (const sim::Segment& segment : world.segments) {
    const auto first = [&](double v) { return static_cast<int>(std::floor((v - radius) / kCell)); };
    const auto last = [&](double v) { return static_cast<int>(std::ceil((v + radius) / kCell)); };
    const auto [x0, x1] = std::minmax(segment.from.x(), segment.to.x());
    const auto [y0, y1] = std::minmax(segment.from.y(), segment.to.y());
    for (int row = std::max(0, first(y0)); row < std::min(rows_, last(y1)); ++row)
      for (int column = std::max(0, first(x0)); column < std::min(columns_, last(x1)); ++column) {
        const Vec2 at = middle(column, row);
        if ((sim::nearest_point(segment, at) - at).norm() <= radius)
          cells_[index(column, row)] = Cell::kBlocked;
      }
  }
  const Vec2 start = world.start.value_or(Pose{}).position();
  std::vector<std::pair<int, int>> open{
      {static_cast<int>(start.x() / kCell), static_cast<int>(start.y() / kCell)}};
  while (!open.empty()) {
    const auto [column, row] = open.back();
    open.pop_back();
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_)
      continue;
    Cell& cell = cells_[index(column, row)];
    if (cell != Cell::kFree)
      continue;
    cell = Cell::kReached;
    open.insert(open.end(),
                {{column + 1, row}, {column - 1, row}, {column, row + 1}, {column, row - 1}});
  }
}

std::size_t Reach::index(int column, int row) const {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
         static_cast<std::size_t>(column);
}

bool Reach::at(const Vec2& position) const {
  const int column = static_cast<int>(std::floor(position.x() / kCell));
  const int row = static_cast<int>(std::floor(position.y() / kCell));
  for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1); ++c)
    for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r)
      if (cells_[index(c, r)] == Cell::kReached)
        return true;
  return false;
}

double Reach::share_of(const maps::Feature& room) const {
  double free = 0.0;
  double reached = 0.0;
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
      if (maps::contains(room, middle(column, row))) {
        free += cells_[index(column, row)] != Cell::kBlocked ? 1.0 : 0.0;
        reached += cells_[index(column, row)] == Cell::kReached ? 1.0 : 0.0;
      }
  return free == 0.0 ? 0.0 : reached / free;
}

}  // namespace saphira::test
