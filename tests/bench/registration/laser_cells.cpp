#include "laser_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace saphira::bench {

using namespace logs;

namespace {

constexpr double kReach = 8.0;        // [m] beyond it a beam is wider than a cell
constexpr double kMargin = 0.5;       // [m]
constexpr double kShort = 0.1;        // [m] before its end a beam may graze the surface
constexpr int kHits = 3;              // of an occupied cell
constexpr double kShare = 0.2;        // and share of the beams that reached it
constexpr int kPasses = 3;            // of a free one
constexpr double kApart = 0.15;       // [m]
constexpr double kMostCells = 200e6;  // a larger grid means a broken log

constexpr double kStep = 0.5 * LaserCells::kCell;

int steps_of(double length) {
  return length > 0.0 ? static_cast<int>(std::ceil(length / kStep - 1e-9)) : 0;
}

void count(std::uint16_t& value) {
  if (value < std::numeric_limits<std::uint16_t>::max())
    ++value;
}

}  // namespace

LaserCells::LaserCells(const std::vector<logs::Scan>& scans, const std::vector<Pose>& poses) {
  if (poses.empty())
    return;
  Vec2 high = low_ = poses.front().position();
  const auto for_points = [&](auto&& f) {
    for (std::size_t i = 0; i < scans.size(); ++i)
      for (const Vec2& point : scans[i].points)
        if (point.norm() <= kReach)
          f(poses[i].position(), transform(poses[i], point));
  };
  for_points([&](const Vec2& from, const Vec2& at) {
    low_ = low_.cwiseMin(at).cwiseMin(from);
    high = high.cwiseMax(at).cwiseMax(from);
  });
  low_ -= Vec2(kMargin, kMargin);
  const Vec2 size = (high + Vec2(kMargin, kMargin) - low_) / kCell;
  if (!(size.x() * size.y() < kMostCells))
    return;
  columns_ = static_cast<std::size_t>(size.x()) + 1;
  rows_ = static_cast<std::size_t>(size.y()) + 1;
  cells_.resize(columns_ * rows_);
  for_points([&](const Vec2& from, const Vec2& at) {
    pass(from, at);
    if (const auto i = index(at))
      count(cells_[*i].hits);
  });
  for (Cell& cell : cells_)
    cell.occupied = cell.hits >= kHits && cell.hits >= kShare * (cell.hits + cell.passes);
  const int apart = static_cast<int>(std::lround(kApart / kCell));
  for (const Vec2& at : surfaces())
    for (int y = -apart; y <= apart; ++y)
      for (int x = -apart; x <= apart; ++x)
        if (const auto i = index(at + kCell * Vec2(x, y)))
          cells_[*i].near_occupied = true;
}

std::optional<std::size_t> LaserCells::index(const Vec2& at) const {
  const Vec2 from = (at - low_) / kCell;
  if (!(from.x() >= 0.0 && from.y() >= 0.0 && from.x() < static_cast<double>(columns_) &&
        from.y() < static_cast<double>(rows_)))
    return std::nullopt;
  return static_cast<std::size_t>(from.y()) * columns_ + static_cast<std::size_t>(from.x());
}

Vec2 LaserCells::middle(std::size_t index) const {
  const std::size_t row = index / columns_;
  const std::size_t column = index % columns_;
  return low_ + kCell * Vec2(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
}

void LaserCells::pass(const Vec2& from, const Vec2& to) {
  const double length = (to - from).norm();
  std::optional<std::size_t> last;
  const int steps = steps_of(length - kShort);
  for (int step = 0; step < steps; ++step) {
    const auto i = index(from + step * kStep / length * (to - from));
    if (i && i != last)
      count(cells_[*i].passes);
    last = i;
  }
}

bool LaserCells::occupied(const Vec2& at) const {
  const auto i = index(at);
  return i && cells_[*i].occupied;
}

bool LaserCells::free(const Vec2& at) const {
  const auto i = index(at);
  return i && cells_[*i].passes >= kPasses && !cells_[*i].near_occupied;
}

bool LaserCells::near(const Vec2& at, double distance) const {
  const int reach = static_cast<int>(distance / kCell) + 1;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) {
      const auto i = index(at + kCell * Vec2(x, y));
      if (i && cells_[*i].occupied && (middle(*i) - at).norm() <= distance)
        return true;
    }
  return false;
}

std::optional<double> LaserCells::beside(const Vec2& at, double direction, double reach) const {
  const Vec2 way(std::cos(direction), std::sin(direction));
  const int steps = steps_of(reach);
  for (int step = 0; step <= steps; ++step)
    for (const double off : {step * kStep, -step * kStep})
      if (occupied(at + off * way))
        return off;
  return std::nullopt;
}

std::vector<Vec2> LaserCells::surfaces() const {
  std::vector<Vec2> out;
  for (std::size_t i = 0; i < cells_.size(); ++i)
    if (cells_[i].occupied)
      out.push_back(middle(i));
  return out;
}

bool LaserCells::sees(const Vec2& from, const Vec2& to) const {
  const double length = (to - from).norm();
  const int steps = steps_of(length - kApart);
  for (int step = 0; step < steps; ++step)
    if (occupied(from + step * kStep / length * (to - from)))
      return false;
  return true;
}

maps::Raster LaserCells::raster() const {
  maps::Raster raster;
  raster.lower_left_in_map = {low_.x(), low_.y(), 0.0};
  raster.cell = kCell;
  raster.width = static_cast<int>(columns_);
  raster.height = static_cast<int>(rows_);
  for (const Cell& cell : cells_)
    raster.occupied.push_back(cell.occupied ? 1.0F : cell.passes + cell.hits == 0 ? -1.0F : 0.0F);
  return raster;
}

}  // namespace saphira::bench
