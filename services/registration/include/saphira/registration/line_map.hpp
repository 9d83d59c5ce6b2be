#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::registration {

/// A straight surface of the map's walls.
struct Surface {
  Vec2 from{0.0, 0.0};
  Vec2 to{0.0, 0.0};
  double heading = 0.0;      ///< [rad] from `from` to `to`
  double length = 0.0;       ///< [m]
  Vec2 free{0.0, 0.0};       ///< the unit normal towards the open side; zero where both are open
  std::size_t feature = 0;   ///< in the map: its corridor, wall, office or object
  bool from_is_end = false;  ///< an opening begins at `from`, not an inner corner
  bool to_is_end = false;
};

/// An interruption of a wall: a door, a break, or the beginning of another corridor.
struct Opening {
  Pose pose_in_map;         ///< the middle; the heading is the normal, into the region of its wall
  double width = 0.0;       ///< [m]
  std::size_t feature = 0;  ///< the door, break or junction; else the corridor that begins here
};

/// The surfaces of a map's artifacts that reflect sound: the two sides and the ends of a corridor,
/// the four sides of an office, without doors and breaks, and without parts before another
/// corridor, a junction or another part of the same office.
class LineMap {
 public:
  explicit LineMap(const maps::Map& map);

  const std::vector<Surface>& surfaces() const { return surfaces_; }
  const std::vector<Opening>& openings() const { return openings_; }
  bool empty() const { return surfaces_.empty(); }

 private:
  void add_region(const maps::Map& map, std::size_t index);

  std::vector<Surface> surfaces_;
  std::vector<Opening> openings_;
};

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
  double distance(const Vec2& position_in_map) const { return nearest(position_in_map).distance; }
  /// True where the map defines the place: the inside of a corridor, junction, lane or office. In a
  /// map of walls alone, everything within them.
  bool known(const Vec2& position_in_map) const;

 private:
  static constexpr double kCell = 0.1;    // [m]
  static constexpr double kMargin = 1.0;  // [m] beyond the outermost surface
  static constexpr std::uint16_t kNone = 0xFFFF;
  std::optional<std::size_t> index(const Vec2& position) const;

  Vec2 corner_{0.0, 0.0};
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint16_t> nearest_;  // of surfaces, by rows
  std::vector<std::uint8_t> known_;
  struct Line {
    Vec2 from;
    Vec2 way;  // unit vector
    double length;
  };
  std::vector<Line> lines_;
};

}  // namespace saphira::registration
