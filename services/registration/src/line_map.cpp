#include "saphira/registration/line_map.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "saphira/base/numbers.hpp"
#include "saphira/maps/artifact_traits.hpp"

namespace saphira::registration {
namespace {

using lps::PointType;
using maps::Feature;

// Of a field, which has a 16-bit number for each surface and up to 24 bytes for each cell of 0.1 m.
constexpr std::size_t kMostSurfaces = 65000;
constexpr double kMostArea = 250e3;  // [m2]

bool is_region(const Feature& feature) {
  return maps::traits(feature.type).region.has_value();
}

/// The lower and the upper corner of all surfaces.
std::pair<Vec2, Vec2> extent(const LineMap& lines) {
  if (lines.empty())
    return {{0.0, 0.0}, {0.0, 0.0}};
  Vec2 low = lines.surfaces().front().from;
  Vec2 high = low;
  for (const Surface& surface : lines.surfaces())
    for (const Vec2& end : {surface.from, surface.to}) {
      low = low.cwiseMin(end);
      high = high.cwiseMax(end);
    }
  return {low, high};
}

}  // namespace

std::optional<std::string> problem(const LineMap& lines) {
  if (lines.surfaces().size() > kMostSurfaces)
    return "expected a map of at most 65000 walls, got " + std::to_string(lines.surfaces().size());
  const auto [low, high] = extent(lines);
  const Vec2 size = high - low;
  if (!(size.x() * size.y() <= kMostArea))
    return "expected a map of at most " + plain(kMostArea / 1e4) +
           " ha, as 500 m by 500 m, got one of " + plain(size.x()) + " m by " + plain(size.y()) +
           " m";
  return std::nullopt;
}

Field::Field(const maps::Map& map, const LineMap& lines) {
  if (const auto why = problem(lines))
    throw std::invalid_argument(*why);
  for (const Surface& surface : lines.surfaces())
    lines_.push_back({surface.from, (surface.to - surface.from) / surface.length, surface.length});
  if (lines_.empty())
    return;
  const std::pair<Vec2, Vec2> corners = extent(lines);
  const Vec2 low = corners.first;
  const Vec2 high = corners.second;
  corner_ = low - Vec2(kMargin, kMargin);
  columns_ = static_cast<int>((high.x() - low.x() + 2.0 * kMargin) / kCell) + 1;
  rows_ = static_cast<int>((high.y() - low.y() + 2.0 * kMargin) / kCell) + 1;
  const auto cells = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  nearest_.assign(cells, kNone);
  known_.assign(cells, 0);
  std::vector<float> distances(cells, 1e9F);
  const auto middle = [&](int column, int row) {
    return Vec2(corner_.x() + (column + 0.5) * kCell, corner_.y() + (row + 0.5) * kCell);
  };
  const auto at = [&](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  };
  const auto offer = [&](int column, int row, std::uint16_t line) {
    const Line& l = lines_[line];
    const Vec2 p = middle(column, row) - l.from;
    const double t = std::clamp(p.dot(l.way), 0.0, l.length);
    const auto d = static_cast<float>((p - l.way * t).norm());
    const std::size_t i = at(column, row);
    if (d < distances[i]) {
      distances[i] = d;
      nearest_[i] = line;
    }
  };
  for (std::size_t k = 0; k < lines_.size(); ++k)
    for (int step = 0; step * kCell / 2.0 <= lines_[k].length; ++step)
      if (const auto i = index(lines_[k].from + lines_[k].way * (step * kCell / 2.0)))
        offer(static_cast<int>(*i % static_cast<std::size_t>(columns_)),
              static_cast<int>(*i / static_cast<std::size_t>(columns_)),
              static_cast<std::uint16_t>(k));
  // The nearest surface of a neighbour may be the nearest here: sweeps to and fro (Danielsson
  // 1980).
  const auto spread = [&](int column, int row, int dc, int dr) {
    const int c = column + dc;
    const int r = row + dr;
    if (c < 0 || r < 0 || c >= columns_ || r >= rows_)
      return;
    const std::uint16_t line = nearest_[at(c, r)];
    if (line != kNone && line != nearest_[at(column, row)])
      offer(column, row, line);
  };
  for (int round = 0; round < 2; ++round) {
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column)
        for (const auto& [dc, dr] : {std::pair{-1, 0}, {0, -1}, {-1, -1}, {1, -1}})
          spread(column, row, dc, dr);
      for (int column = columns_ - 1; column >= 0; --column)
        spread(column, row, 1, 0);
    }
    for (int row = rows_ - 1; row >= 0; --row) {
      for (int column = columns_ - 1; column >= 0; --column)
        for (const auto& [dc, dr] : {std::pair{1, 0}, {0, 1}, {1, 1}, {-1, 1}})
          spread(column, row, dc, dr);
      for (int column = 0; column < columns_; ++column)
        spread(column, row, -1, 0);
    }
  }
  const bool has_regions =
      std::any_of(map.features.begin(), map.features.end(), [](const Feature& f) {
        return is_region(f) && f.type != PointType::junction && f.type != PointType::lane;
      });
  std::vector<maps::Rectangle> regions;
  for (const Feature& feature : map.features)
    if (is_region(feature))
      regions.emplace_back(feature);
  const auto inside = [&](const Vec2& p) {
    if (!has_regions)
      return p.x() > low.x() && p.y() > low.y() && p.x() < high.x() && p.y() < high.y();
    return std::any_of(regions.begin(), regions.end(),
                       [&](const maps::Rectangle& region) { return region.contains(p); });
  };
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
      if (inside(middle(column, row)))
        known_[at(column, row)] = 1;
}

Field::Nearest Field::nearest(const Vec2& position) const {
  const auto i = index(position);
  if (!i || nearest_[*i] == kNone)
    return {};
  const Vec2 way = way_to(lines_[nearest_[*i]], position);
  const double d = way.norm();
  return {d, d > 1e-9 ? Vec2(way / d) : Vec2(1.0, 0.0)};
}

bool Field::known(const Vec2& position) const {
  const auto i = index(position);
  return i && known_[*i] != 0;
}

}  // namespace saphira::registration
