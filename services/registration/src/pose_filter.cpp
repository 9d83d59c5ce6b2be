#include "saphira/registration/pose_filter.hpp"

#include <cmath>

namespace saphira::registration {

PoseFilter::PoseFilter(const Pose& pose, const Eigen::Matrix3d& covariance, double drift,
                       double drift_variance, const ReckoningErrors& errors)
    : state_(pose.x, pose.y, norm2_angle(pose.th), drift),
      covariance_(Covariance::Zero()),
      errors_(errors) {
  covariance_.topLeftCorner<3, 3>() = covariance;
  covariance_(3, 3) = drift_variance;
}

void PoseFilter::move(const Pose& moved) {
  const double way = moved.x;
  const double length = std::hypot(moved.x, moved.y);
  const double turn = moved.th - state_[3] * way;
  // Half-way, dead reckoning had turned by half of its drift.
  const double heading = state_[2] - state_[3] * way / 2.0;
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  const double dx = c * moved.x - s * moved.y;
  const double dy = s * moved.x + c * moved.y;
  Covariance f = Covariance::Identity();
  f(0, 2) = -dy;
  f(1, 2) = dx;
  f(0, 3) = dy * way / 2.0;
  f(1, 3) = -dx * way / 2.0;
  f(2, 3) = -way;
  state_[0] += dx;
  state_[1] += dy;
  state_[2] = norm2_angle(state_[2] + turn);
  covariance_ = f * covariance_ * f.transpose();
  const double along = errors_.way * errors_.way * length;
  covariance_(0, 0) += along * c * c;
  covariance_(0, 1) += along * c * s;
  covariance_(1, 0) += along * c * s;
  covariance_(1, 1) += along * s * s;
  covariance_(2, 2) +=
      errors_.turn * errors_.turn * std::abs(moved.th) + errors_.heading * errors_.heading * length;
  covariance_(3, 3) += errors_.drift_walk * errors_.drift_walk * length;
}

double PoseFilter::sigma_position() const {
  const double a = covariance_(0, 0);
  const double b = covariance_(1, 1);
  const double c = covariance_(0, 1);
  return std::sqrt((a + b) / 2.0 + std::sqrt((a - b) * (a - b) / 4.0 + c * c));
}

void PoseFilter::widen(double position, double heading) {
  covariance_(0, 0) += position * position;
  covariance_(1, 1) += position * position;
  covariance_(2, 2) += heading * heading;
}

}  // namespace saphira::registration
