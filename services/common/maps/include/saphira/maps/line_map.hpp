#pragma once

#include <cstddef>
#include <vector>

#include "saphira/geometry/edge.hpp"
#include "saphira/geometry/pose.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::maps {

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
  explicit LineMap(const Map& map);

  const std::vector<Surface>& surfaces() const { return surfaces_; }
  const std::vector<Opening>& openings() const { return openings_; }
  bool empty() const { return surfaces_.empty(); }
  /// The surfaces nearest to a place, `most` at most, the nearest first.
  std::vector<Edge> edges_near(const Vec2& position_in_map, std::size_t most) const;

 private:
  void add_region(const Map& map, std::size_t index);

  std::vector<Surface> surfaces_;
  std::vector<Opening> openings_;
};

}  // namespace saphira::maps
