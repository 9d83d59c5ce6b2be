#include "saphira/registration/line_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "saphira/base/numbers.hpp"
#include "saphira/geometry/clip.hpp"
#include "saphira/maps/artifact_traits.hpp"

namespace saphira::registration {
namespace {

using lps::PointType;
using maps::Feature;

constexpr double kOnWall = 0.25;   // [m] largest distance of a door from its wall
constexpr double kBeyond = 0.1;    // [m] a region this near behind a side is open to it
constexpr double kShortest = 0.1;  // [m] of surfaces that are kept
// Of a field, which has a 16-bit number for each surface and up to 24 bytes for each cell of 0.1 m.
constexpr std::size_t kMostSurfaces = 65000;
constexpr double kMostArea = 250e3;  // [m2]

bool is_region(const Feature& feature) {
  return maps::traits(feature.type).region.has_value();
}

bool is_way(const Feature& feature) {
  return is_region(feature) && maps::traits(feature.type).region != maps::RegionKind::room;
}

/// True where there is a free passage between two touching features.
bool open_to(const Feature& a, const Feature& b) {
  if (is_way(a) && is_way(b))
    return true;
  return a.type == PointType::office && b.type == PointType::office && !a.name.empty() &&
         a.name == b.name;
}

/// The part of the line from `start` along `way` that lies in the rectangle.
std::optional<Stretch> part_in(const Feature& box, const Vec2& start, const Vec2& way,
                               double length) {
  const ToFrame to_box(box.pose_in_map);
  const Vec2 a = to_box(start);
  const auto part =
      clip(a, to_box(start + way) - a, {box.length / 2.0, box.width / 2.0}, {0.0, length});
  if (!part || part->to - part->from < 1e-6)
    return std::nullopt;
  return part;
}

/// [0, length] without the holes.
std::vector<Stretch> without(double length, std::vector<Stretch> holes) {
  std::sort(holes.begin(), holes.end(),
            [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
  std::vector<Stretch> left;
  double at = 0.0;
  for (const Stretch& hole : holes) {
    if (hole.from - at > kShortest)
      left.push_back({at, hole.from});
    at = std::max(at, hole.to);
  }
  if (length - at > kShortest)
    left.push_back({at, length});
  return left;
}

Surface surface(const Vec2& from, const Vec2& to, const Vec2& free, std::size_t feature) {
  const Vec2 way = to - from;
  return {from, to, std::atan2(way.y(), way.x()), way.norm(), free, feature, false, false};
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

struct Side {
  Vec2 start;
  Vec2 way;  // unit vector; the free side is to its left
  double length;
};

std::array<Side, 4> sides(const Feature& box) {
  const double l = box.length / 2.0;
  const double w = box.width / 2.0;
  const Vec2 along = box.pose_in_map.direction();
  const Vec2 across{-along.y(), along.x()};
  return {{{transform(box.pose_in_map, {-l, -w}), along, box.length},
           {transform(box.pose_in_map, {l, -w}), across, box.width},
           {transform(box.pose_in_map, {l, w}), -along, box.length},
           {transform(box.pose_in_map, {-l, w}), -across, box.width}}};
}

}  // namespace

LineMap::LineMap(const maps::Map& map) {
  for (std::size_t i = 0; i < map.features.size(); ++i) {
    const Feature& feature = map.features[i];
    // An artifact that was placed by the pose cannot correct the pose.
    if (feature.type == PointType::object && feature.learned)
      continue;
    if (feature.type == PointType::wall) {
      const Vec2 half = feature.pose_in_map.direction() * feature.length / 2.0;
      const Vec2 middle = feature.pose_in_map.position();
      surfaces_.push_back(surface(middle - half, middle + half, {0.0, 0.0}, i));
    } else if (feature.type == PointType::object) {
      for (const Side& side : sides(feature))
        surfaces_.push_back(surface(side.start, side.start + side.way * side.length,
                                    {side.way.y(), -side.way.x()}, i));
    } else if (is_region(feature) && feature.type != PointType::junction) {
      add_region(map, i);
    }
  }
}

void LineMap::add_region(const maps::Map& map, std::size_t index) {
  const Feature& region = map.features[index];
  for (const Side& side : sides(region)) {
    const Vec2 inwards{-side.way.y(), side.way.x()};
    std::vector<Stretch> holes;
    // Doors and breaks first, so that a corridor behind one does not become another opening.
    for (std::size_t i = 0; i < map.features.size(); ++i) {
      const Feature& door = map.features[i];
      if (!maps::traits(door.type).gate)
        continue;
      const Vec2 off = door.pose_in_map.position() - side.start;
      const double at = off.dot(side.way);
      if (std::abs(off.dot(inwards)) > kOnWall || at < 0.0 || at > side.length ||
          std::abs(door.pose_in_map.direction().dot(inwards)) < std::cos(radians(30.0)))
        continue;
      holes.push_back({at - door.width / 2.0, at + door.width / 2.0});
      const Vec2 middle = side.start + side.way * at;
      openings_.push_back(
          {{middle.x(), middle.y(), std::atan2(inwards.y(), inwards.x())}, door.width, i});
    }
    std::vector<Stretch> gaps;
    for (std::size_t i = 0; i < map.features.size(); ++i) {
      const Feature& other = map.features[i];
      if (i == index || !is_region(other) || !open_to(region, other))
        continue;
      const auto part = part_in(other, side.start - inwards * kBeyond, side.way, side.length);
      if (!part)
        continue;
      holes.push_back(*part);
      const double width = part->to - part->from;
      // A corridor that meets this side from the side is an opening in it.
      if (is_way(other) && part->from > 0.05 && part->to < side.length - 0.05 && width > 0.5) {
        const bool there = std::any_of(gaps.begin(), gaps.end(), [&](const Stretch& gap) {
          return std::abs(gap.from - part->from) < 0.2 && std::abs(gap.to - part->to) < 0.2;
        });
        if (!there) {
          gaps.push_back(*part);
          const Vec2 middle = side.start + side.way * (part->from + part->to) / 2.0;
          std::size_t what = i;
          for (std::size_t j = 0; j < map.features.size(); ++j)
            if (map.features[j].type == PointType::junction &&
                maps::contains(map.features[j], middle + inwards * 0.2))
              what = j;
          openings_.push_back(
              {{middle.x(), middle.y(), std::atan2(inwards.y(), inwards.x())}, width, what});
        }
      }
    }
    for (const Stretch& part : without(side.length, holes)) {
      Surface piece = surface(side.start + side.way * part.from, side.start + side.way * part.to,
                              inwards, index);
      piece.from_is_end = part.from > 0.0;
      piece.to_is_end = part.to < side.length;
      surfaces_.push_back(piece);
    }
  }
}

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
      std::any_of(map.features.begin(), map.features.end(),
                  [](const Feature& f) { return is_region(f) && f.type != PointType::junction; });
  const auto inside = [&](const Vec2& p) {
    if (!has_regions)
      return p.x() > low.x() && p.y() > low.y() && p.x() < high.x() && p.y() < high.y();
    return std::any_of(map.features.begin(), map.features.end(),
                       [&](const Feature& f) { return is_region(f) && maps::contains(f, p); });
  };
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
      if (inside(middle(column, row)))
        known_[at(column, row)] = 1;
}

std::optional<std::size_t> Field::index(const Vec2& position) const {
  const double column = (position.x() - corner_.x()) / kCell;
  const double row = (position.y() - corner_.y()) / kCell;
  if (!(column >= 0.0 && row >= 0.0 && column < columns_ && row < rows_))
    return std::nullopt;
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
         static_cast<std::size_t>(column);
}

Field::Nearest Field::nearest(const Vec2& position) const {
  const auto i = index(position);
  if (!i || nearest_[*i] == kNone)
    return {};
  const Line& line = lines_[nearest_[*i]];
  const Vec2 p = position - line.from;
  const double t = std::clamp(p.dot(line.way), 0.0, line.length);
  const Vec2 towards = line.way * t - p;
  const double d = towards.norm();
  return {d, d > 1e-9 ? Vec2(towards / d) : Vec2(1.0, 0.0)};
}

bool Field::known(const Vec2& position) const {
  const auto i = index(position);
  return i && known_[*i] != 0;
}

}  // namespace saphira::registration
