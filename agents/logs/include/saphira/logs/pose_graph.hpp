#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::logs {

/// A measured pose of node `to` relative to node `from`.
struct PoseEdge {
  std::size_t from = 0;
  std::size_t to = 0;
  Pose to_in_from;
  /// Of the deviation (x, y, th) in the frame of the measured pose.
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  /// Possibly wrong: loses its weight where it disagrees with the rest.
  bool doubtful = false;
};

/// The remaining disagreement of an edge with the poses: squared, in sigmas.
double chi2(const PoseEdge& edge, const std::vector<Pose>& poses);

struct GraphReport {
  int iterations = 0;
  double before = 0.0;  ///< robust cost
  double after = 0.0;
};

/// Moves the poses to their best agreement with the edges: sparse least squares (Gauss and Newton
/// with damping); the first pose stays. Doubtful edges have a Cauchy kernel of `kernel` sigmas.
GraphReport optimize(std::vector<Pose>& poses, const std::vector<PoseEdge>& edges,
                     int iterations = 20, double kernel = 3.0);

}  // namespace saphira::logs
