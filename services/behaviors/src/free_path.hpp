#pragma once

#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::behaviors {

/// How far [m] a disc of `radius` [m] at the robot's centre can go in `direction` [rad from ahead]
/// until one of `points` (robot frame) is on its rim; at most `limit`. A point that is within the
/// disc counts as soon as it lies towards the direction: then there is no way at all.
double free_path(const std::vector<Vec2>& points, double direction, double radius, double limit);

/// How far [m] from the nearest of `points` (robot frame) the robot's centre passes on a way of
/// `reach` [m] in `direction` [rad from ahead]; at most `most`. What is beside or behind is passed.
double clearance(const std::vector<Vec2>& points, double direction, double reach, double most);

}  // namespace saphira::behaviors
