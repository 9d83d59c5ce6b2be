#include "saphira/maps/line_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "saphira/geometry/clip.hpp"
#include "saphira/maps/artifact_traits.hpp"

namespace saphira::maps {
namespace {

using lps::PointType;

constexpr double kOnWall = 0.25;   // [m] largest distance of a door from its wall
constexpr double kBeyond = 0.1;    // [m] a region this near behind a side is open to it
constexpr double kShortest = 0.1;  // [m] of surfaces that are kept

bool is_region(const Feature& feature) {
  return traits(feature.type).region.has_value();
}

bool is_way(const Feature& feature) {
  return is_region(feature) && traits(feature.type).region != RegionKind::room;
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

LineMap::LineMap(const Map& map) {
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
    } else if (is_region(feature) && feature.type != PointType::junction &&
               feature.type != PointType::lane) {
      add_region(map, i);
    }
  }
}

std::vector<Edge> LineMap::edges_near(const Vec2& position, std::size_t most) const {
  std::vector<std::pair<double, std::size_t>> near;
  near.reserve(surfaces_.size());
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const Surface& surface = surfaces_[i];
    const Vec2 way = surface.to - surface.from;
    const double along =
        std::clamp((position - surface.from).dot(way) / way.squaredNorm(), 0.0, 1.0);
    near.emplace_back((surface.from + along * way - position).norm(), i);
  }
  if (near.size() > most) {
    std::nth_element(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(most), near.end());
    near.resize(most);
  }
  std::sort(near.begin(), near.end());
  std::vector<Edge> edges;
  for (const auto& [away, i] : near)
    edges.push_back({surfaces_[i].from, surfaces_[i].to});
  return edges;
}

void LineMap::add_region(const Map& map, std::size_t index) {
  const Feature& region = map.features[index];
  for (const Side& side : sides(region)) {
    const Vec2 inwards{-side.way.y(), side.way.x()};
    std::vector<Stretch> holes;
    // Doors and breaks first, so that a corridor behind one does not become another opening.
    for (std::size_t i = 0; i < map.features.size(); ++i) {
      const Feature& door = map.features[i];
      if (!traits(door.type).gate)
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
                contains(map.features[j], middle + inwards * 0.2))
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

}  // namespace saphira::maps
