#include "saphira/geometry/axes.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace saphira {
namespace {

TEST(PrincipalAxes, AreThoseOfATurnedEllipse) {
  const double angle = 0.7;
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Matrix2d covariance =
      4.0 * along * along.transpose() + 1e-4 * across * across.transpose();
  const auto axes = principal_axes(covariance);
  EXPECT_NEAR(axes.eigenvalues()[0], 1e-4, 1e-12);
  EXPECT_NEAR(axes.eigenvalues()[1], 4.0, 1e-12);
  EXPECT_NEAR(std::abs(axes.eigenvectors().col(0).dot(across)), 1.0, 1e-12);
  EXPECT_NEAR(std::abs(axes.eigenvectors().col(1).dot(along)), 1.0, 1e-12);
}

TEST(PrincipalAxes, OfACircleAndOfNothingAreSomeRightAngle) {
  for (const double size : {1.0, 0.0}) {
    const auto axes = principal_axes(size * Eigen::Matrix2d::Identity());
    EXPECT_DOUBLE_EQ(axes.eigenvalues()[0], size);
    EXPECT_DOUBLE_EQ(axes.eigenvalues()[1], size);
    EXPECT_NEAR(axes.eigenvectors().determinant() * axes.eigenvectors().determinant(), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace saphira
