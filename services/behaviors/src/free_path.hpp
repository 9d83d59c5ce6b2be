#pragma once

#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::behaviors {

/// The way [m] of a disc of `radius` [m] at the robot's centre in `direction` [rad from ahead]
/// until one of `points` (robot frame) is on its rim; at most `limit`. A point within the disc
/// counts when it lies towards the direction: then the way is 0.
double free_path(const std::vector<Vec2>& points, double direction, double radius, double limit);

/// The smallest distance [m] of `points` (robot frame) from the way of the robot's centre, of
/// length `reach` [m] in `direction` [rad from ahead]; at most `most`. Points beside or behind do
/// not count.
double clearance(const std::vector<Vec2>& points, double direction, double reach, double most);

}  // namespace saphira::behaviors
