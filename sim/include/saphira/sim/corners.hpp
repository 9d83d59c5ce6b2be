#pragma once

#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::sim {

struct Segment;

/// Where the course of a wall changes: an edge, a corner of a room, a door post. A sonar hears it
/// from directions from which it would not hear a smooth wall.
struct Corner {
  Vec2 point{0.0, 0.0};      ///< [m] in the world
  std::vector<double> arms;  ///< [rad] the directions of the walls that meet here, ascending
};

/// The corners of all segments: their ends, but where a wall goes straight on. Ends that are nearer
/// to each other than 2 mm are one.
std::vector<Corner> find_corners(const std::vector<Segment>& segments);

/// Whether the corner sends sound back to a viewer: on his side the walls turn. (Where a partition
/// meets a wall from behind, the wall is smooth on this side.)
bool is_sharp_from(const Corner& corner, const Vec2& viewer);

}  // namespace saphira::sim
