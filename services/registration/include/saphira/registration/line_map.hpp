#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/maps/line_map.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::registration {

using maps::LineMap;
using maps::Opening;
using maps::Surface;

/// The reason why no robot can be registered on a map of these lines, in words; none where one can.
std::optional<std::string> problem(const LineMap& lines);

/// The nearest surface to any point of the map, from a grid of nearest surfaces; the distance to
/// that surface is exact.
class Field {
 public:
  /// std::invalid_argument where there is a `problem`.
  Field(const maps::Map& map, const LineMap& lines);

  struct Nearest {
    double distance = 1e3;
    Vec2 towards{1.0, 0.0};  ///< unit vector
  };
  Nearest nearest(const Vec2& position_in_map) const;
  double distance(const Vec2& position_in_map) const {
    const auto i = index(position_in_map);
    return i && nearest_[*i] != kNone ? way_to(lines_[nearest_[*i]], position_in_map).norm()
                                      : Nearest{}.distance;
  }
  /// True where the map defines the place: the inside of a corridor, junction, lane or office. In a
  /// map of walls alone, everything within them.
  bool known(const Vec2& position_in_map) const;

 private:
  static constexpr double kCell = 0.1;    // [m]
  static constexpr double kMargin = 1.0;  // [m] beyond the outermost surface
  static constexpr std::uint16_t kNone = 0xFFFF;
  struct Line {
    Vec2 from;
    Vec2 way;  // unit vector
    double length;
  };
  static Vec2 way_to(const Line& line, const Vec2& position) {
    const Vec2 p = position - line.from;
    return line.way * std::clamp(p.dot(line.way), 0.0, line.length) - p;
  }
  /// Of a cell.
  std::optional<std::size_t> index(const Vec2& position) const {
    const double column = (position.x() - corner_.x()) / kCell;
    const double row = (position.y() - corner_.y()) / kCell;
    if (!(column >= 0.0 && row >= 0.0 && column < columns_ && row < rows_))
      return std::nullopt;
    return static_cast<std::size_t>(static_cast<int>(row)) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(static_cast<int>(column));
  }

  Vec2 corner_{0.0, 0.0};
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint16_t> nearest_;  // of surfaces, by rows
  std::vector<std::uint8_t> known_;
  std::vector<Line> lines_;
};

}  // namespace saphira::registration
