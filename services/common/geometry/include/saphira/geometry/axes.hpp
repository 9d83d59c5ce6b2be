#pragma once

#include <Eigen/Eigenvalues>

namespace saphira {

/// Eigenvalues, the smaller one first, and eigenvectors (columns of length 1) of a symmetric
/// matrix, such as the covariance of a position [m^2]. In closed form: Eigen's solver for any size
/// takes seconds to compile.
inline Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal_axes(
    const Eigen::Matrix2d& symmetric) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(symmetric);
  return axes;
}

}  // namespace saphira
