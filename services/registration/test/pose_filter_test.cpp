#include "saphira/registration/pose_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace saphira::registration {
namespace {

Eigen::Matrix3d diagonal(double position, double heading) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.diagonal() << position * position, position * position, heading * heading;
  return covariance;
}

TEST(PoseFilter, MovesAndGetsLessSure) {
  PoseFilter filter({1.0, 2.0, kPi / 2}, diagonal(0.01, 0.01), 0.0, 1e-8, {});
  for (int i = 0; i < 100; ++i)
    filter.move({0.03, 0.0, 0.0});
  EXPECT_NEAR(filter.pose().x, 1.0, 1e-9);
  EXPECT_NEAR(filter.pose().y, 5.0, 1e-9);
  EXPECT_NEAR(std::sqrt(filter.covariance()(1, 1)), std::hypot(0.01, 0.03 * std::sqrt(3.0)), 1e-3);
  EXPECT_GT(std::sqrt(filter.covariance()(2, 2)), 0.01);
}

TEST(PoseFilter, LearnsTheDriftOfDeadReckoningFromWalls) {
  constexpr double kDrift = 0.006;  // [rad/m]
  PoseFilter filter({}, diagonal(0.05, 0.05), 0.0, 0.01 * 0.01, {});
  // The robot drives straight; dead reckoning shows a turn.
  for (int i = 1; i <= 1000; ++i) {
    filter.move({0.03, 0.0, kDrift * 0.03});
    if (i % 20 == 0) {
      Eigen::Matrix<double, 2, 4> jacobian = Eigen::Matrix<double, 2, 4>::Zero();
      jacobian(0, 1) = 1.0;
      jacobian(1, 2) = 1.0;
      const Eigen::Vector2d innovation(-filter.pose().y, -filter.pose().th);
      filter.correct<2>(innovation, jacobian, Eigen::Vector2d(0.0004, 0.0003).asDiagonal());
    }
  }
  EXPECT_NEAR(filter.drift(), kDrift, 0.002);
  // Without walls it now goes far.
  for (int i = 0; i < 300; ++i)
    filter.move({0.03, 0.0, kDrift * 0.03});
  EXPECT_NEAR(filter.pose().y, 0.0, 0.15);
}

}  // namespace
}  // namespace saphira::registration
