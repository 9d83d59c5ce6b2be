#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::registration {

struct FeatureGraphSettings {
  // One sigma of dead reckoning, a little worse than the worst robot that should build a map.
  double way_error = 0.02;           ///< [m] after 1 m; grows with the root of the way
  double heading_error = 0.006;      ///< [rad] after 1 m; with the root of the way
  double turn_error = 0.04;          ///< [rad] after a turn of 1 rad; with the root of it
  double drift_error = 0.008;        ///< [rad/m] of the constant part, which is learnt
  double start_position = 0.001;     ///< [m] of the first pose
  double start_heading = 0.001;      ///< [rad]
  double grid_error = radians(0.4);  ///< [rad] of walls about the right-angle grid
  double kernel = 2.5;               ///< [sigma] beyond this, a measurement counts less and less
};

/// A stretch of wall seen from a place on the way.
struct SeenLine {
  std::size_t node = 0;
  Pose in_node = {};    ///< its middle; along it, with the free side on the left
  double length = 0.0;  ///< [m]
  double sigma_across = 0.05;
  double sigma_heading = 0.02;
};

/// A seen opening.
struct SeenPoint {
  std::size_t node = 0;
  Pose in_node = {};  ///< its middle; the normal, towards the robot
  double width = 0.0;
  double sigma_along = 0.1;   ///< [m] along the normal
  double sigma_across = 0.1;  ///< [m] along the wall
};

/// A wall without ends: the points p with normal * (p - anchor) = offset.
struct GraphLine {
  Vec2 anchor{0.0, 0.0};  ///< in the map; stays
  double heading = 0.0;   ///< in the map; the free side is on the left
  double offset = 0.0;    ///< [m] towards the free side
  std::vector<SeenLine> seen;
  bool on_grid = false;  ///< its heading is a multiple of a right angle

  Vec2 along() const { return {std::cos(heading), std::sin(heading)}; }
  Vec2 normal() const { return {-std::sin(heading), std::cos(heading)}; }
  /// A point of the line, with the heading.
  Pose pose() const {
    const Vec2 at = anchor + offset * normal();
    return {at.x(), at.y(), heading};
  }
};

struct GraphPoint {
  Vec2 in_map{0.0, 0.0};
  std::vector<SeenPoint> seen;
};

/// A place on the way.
struct GraphNode {
  Pose in_odom;
  Pose in_map;
  bool fixed = false;   ///< its pose is given
  bool broken = false;  ///< no dead reckoning from the node before
};

/// The robot's way and the walls and openings on it, as one least-squares problem: dead reckoning
/// with a constant drift, lines and points seen from nodes, and lines that follow a grid of right
/// angles. Gauss-Newton with a Cauchy kernel; sparse, one thread, no randomness.
struct FeatureGraph {
  FeatureGraphSettings settings;
  std::vector<GraphNode> nodes;
  std::vector<GraphLine> lines;
  std::vector<GraphPoint> points;
  double drift = 0.0;  ///< [rad/m] of dead reckoning
  /// Of the newest node's pose in the map (x, y, th), by the last optimization.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

  /// The covariance that dead reckoning adds to a pose on a way, in the frame of its start.
  Eigen::Matrix3d way_covariance(const Pose& way) const;
  /// Moves everything to its best fit. Returns the largest correction of a node [m].
  double optimize(int iterations = 5);
};

}  // namespace saphira::registration
