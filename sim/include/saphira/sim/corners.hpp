#pragma once

#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::sim {

struct Segment;

/// A change in the course of a wall: an edge, a corner of a room, a door post. A sonar hears it
/// from directions in which it would not hear a smooth wall.
struct Corner {
  Vec2 point{0.0, 0.0};      ///< [m] in the world
  std::vector<double> arms;  ///< [rad] the directions of the walls that meet here, ascending
  double shortest = 0.0;     ///< [m] the length of the shortest of these walls
};

/// The corners of all segments: their ends, except where a wall goes straight on. Ends within 2 mm
/// of each other are one.
std::vector<Corner> find_corners(const std::vector<Segment>& segments);

/// The kind of a corner, seen from one side of it.
enum class CornerShape {
  kNone,   ///< smooth (a partition meets the wall from behind), or an inner corner that is not
           ///< square
  kEdge,   ///< the walls turn away: a weak echo
  kInner,  ///< a square inner corner: two mirrors that send all sound back
};
CornerShape shape_from(const Corner& corner, const Vec2& viewer);

}  // namespace saphira::sim
