#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::logs {

/// Where node `to` was measured to be from node `from`.
struct PoseEdge {
  std::size_t from = 0;
  std::size_t to = 0;
  Pose to_in_from;
  /// Of the deviation (x, y, th) in the frame of the measured pose.
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  /// May be wrong altogether: loses its weight where it disagrees with the rest.
  bool doubtful = false;
};

/// The rest of an edge's disagreement with the poses: squared, in sigmas.
double chi2(const PoseEdge& edge, const std::vector<Pose>& poses);

struct GraphReport {
  int iterations = 0;
  double before = 0.0;  ///< robust cost
  double after = 0.0;
};

/// Moves the poses to where they agree best with the edges: sparse least squares (Gauss and Newton
/// with damping), the first pose stays. Doubtful edges count by a Cauchy kernel of `kernel` sigmas.
GraphReport optimize(std::vector<Pose>& poses, const std::vector<PoseEdge>& edges,
                     int iterations = 20, double kernel = 3.0);

}  // namespace saphira::logs
