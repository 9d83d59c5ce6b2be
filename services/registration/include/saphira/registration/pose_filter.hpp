#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "saphira/base/archived.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::registration {

/// The errors of dead reckoning; one sigma, growing with the root of the way.
struct ReckoningErrors {
  double way = 0.03;                  ///< [m] after 1 m
  double turn = 0.05;                 ///< [rad] after a turn of 1 rad
  double heading = radians(0.5);      ///< [rad] after 1 m
  double drift_walk = radians(0.01);  ///< [rad/m] change of the drift itself in 1 m
};

/// The robot's pose in the map and the drift of its dead reckoning (a constant false turn per
/// metre, as from unequal wheels), with their covariance.
class PoseFilter {
 public:
  using State = Eigen::Vector4d;  // x, y, th, drift
  using Covariance = Eigen::Matrix4d;

  PoseFilter() = default;  ///< to be restored
  PoseFilter(const Pose& pose, const Eigen::Matrix3d& covariance, double drift,
             double drift_variance, const ReckoningErrors& errors);

  /// The robot's motion by dead reckoning, in its own earlier frame.
  void move(const Pose& moved);
  /// A measurement whose difference from the expectation is `innovation` = `jacobian` * error.
  template <int N>
  void correct(const Eigen::Matrix<double, N, 1>& innovation,
               const Eigen::Matrix<double, N, 4>& jacobian,
               const Eigen::Matrix<double, N, N>& noise);
  template <int N>
  double distance(const Eigen::Matrix<double, N, 1>& innovation,
                  const Eigen::Matrix<double, N, 4>& jacobian,
                  const Eigen::Matrix<double, N, N>& noise) const;

  Pose pose() const { return {state_[0], state_[1], state_[2]}; }
  double drift() const { return state_[3]; }
  const Covariance& covariance() const { return covariance_; }
  Eigen::Matrix3d pose_covariance() const { return covariance_.topLeftCorner<3, 3>(); }
  double sigma_position() const;  ///< [m] along the worst direction
  /// Increases the uncertainty of the pose.
  void widen(double position, double heading);

  SAPHIRA_ARCHIVE(state_, covariance_, errors_)

 private:
  State state_ = State::Zero();
  Covariance covariance_ = Covariance::Zero();
  ReckoningErrors errors_;
};

template <int N>
void PoseFilter::correct(const Eigen::Matrix<double, N, 1>& innovation,
                         const Eigen::Matrix<double, N, 4>& jacobian,
                         const Eigen::Matrix<double, N, N>& noise) {
  const Eigen::Matrix<double, N, N> s = jacobian * covariance_ * jacobian.transpose() + noise;
  const Eigen::Matrix<double, 4, N> gain = covariance_ * jacobian.transpose() * s.inverse();
  state_ += gain * innovation;
  state_[2] = norm2_angle(state_[2]);
  // Joseph's form: stays symmetric and positive.
  const Covariance rest = Covariance::Identity() - gain * jacobian;
  covariance_ = rest * covariance_ * rest.transpose() + gain * noise * gain.transpose();
}

template <int N>
double PoseFilter::distance(const Eigen::Matrix<double, N, 1>& innovation,
                            const Eigen::Matrix<double, N, 4>& jacobian,
                            const Eigen::Matrix<double, N, N>& noise) const {
  const Eigen::Matrix<double, N, N> s = jacobian * covariance_ * jacobian.transpose() + noise;
  return innovation.dot(s.inverse() * innovation);
}

}  // namespace saphira::registration
