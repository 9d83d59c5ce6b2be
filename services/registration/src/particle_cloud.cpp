#include "saphira/registration/particle_cloud.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "saphira/geometry/axes.hpp"

namespace saphira::registration {

void ParticleCloud::begin(const Pose& pose, const Eigen::Matrix3d& covariance, double drift,
                          double drift_sigma) {
  const auto axes = principal_axes(covariance.topLeftCorner<2, 2>());
  const auto sigma = [](double variance, double least) {
    return std::max(std::sqrt(std::max(0.0, variance)), least);
  };
  const double a = sigma(axes.eigenvalues()[0], settings_.least_position);
  const double b = sigma(axes.eigenvalues()[1], settings_.least_position);
  const double turned = sigma(covariance(2, 2), settings_.least_turned);
  moved_ = {};
  length_ = turned_ = 0.0;
  particles_.assign(settings_.particles, {});
  for (Particle& p : particles_) {
    const double along = random_.normal(0.0, a);
    const double across = random_.normal(0.0, b);
    const Vec2 off = along * axes.eigenvectors().col(0) + across * axes.eigenvectors().col(1);
    p.pose = {pose.x + off.x(), pose.y + off.y(),
              norm2_angle(pose.th + random_.normal(0.0, turned))};
    p.ahead = p.pose.direction();
    p.drift = random_.normal(drift, drift_sigma);
  }
}

/// The sum of four uniforms takes a small part of the time of logarithms and cosines.
double ParticleCloud::noise() {
  const double sum = random_.uniform() + random_.uniform() + random_.uniform() + random_.uniform();
  return (sum - 2.0) * std::sqrt(3.0);
}

void ParticleCloud::move(const Pose& moved) {
  moved_ = compose(moved_, moved);
  length_ += std::hypot(moved.x, moved.y);
  turned_ += std::abs(moved.th);
}

void ParticleCloud::settle() {
  if (length_ == 0.0 && turned_ == 0.0)
    return;
  const Pose moved = std::exchange(moved_, Pose{});
  const double length = std::exchange(length_, 0.0);
  const double turned = std::exchange(turned_, 0.0);
  const double root = std::sqrt(length);
  const double turn_sigma = std::sqrt(settings_.turn * settings_.turn * turned +
                                      settings_.heading * settings_.heading * length);
  for (Particle& p : particles_) {
    const double turn = p.drift * moved.x + turn_sigma * noise();
    const double way = settings_.way * root * noise();
    // It turns by little: half of it to the first order.
    const double c = p.ahead.x() + p.ahead.y() * turn / 2.0;
    const double s = p.ahead.y() - p.ahead.x() * turn / 2.0;
    p.pose.x += c * (moved.x + way) - s * moved.y;
    p.pose.y += s * (moved.x + way) + c * moved.y;
    p.pose.th = norm2_angle(p.pose.th + moved.th - turn);
    p.ahead = p.pose.direction();
    p.drift += settings_.drift_walk * root * noise();
  }
}

std::vector<double> ParticleCloud::weights() const {
  double most = -1e300;
  for (const Particle& p : particles_)
    most = std::max(most, p.log_weight);
  std::vector<double> result;
  result.reserve(particles_.size());
  double sum = 0.0;
  for (const Particle& p : particles_) {
    result.push_back(std::exp(p.log_weight - most));
    sum += result.back();
  }
  for (double& weight : result)
    weight /= sum;
  return result;
}

void ParticleCloud::learn(const Pose& before, const Eigen::Matrix3d& covariance_before,
                          const Pose& after, const Eigen::Matrix3d& covariance_after) {
  constexpr double kLeast = -4.5;  // three sigmas: the match may be wrong
  settle();
  const Eigen::Matrix3d information = covariance_after.inverse();
  const Eigen::Matrix3d learnt = information - covariance_before.inverse();
  const auto off = [&before](const Pose& pose) {
    return Eigen::Vector3d(pose.x - before.x, pose.y - before.y, norm2_angle(pose.th - before.th));
  };
  const Eigen::Vector3d pull = information * off(after);
  std::vector<double> logs;
  double most = -1e300;
  for (const Particle& p : particles_) {
    const Eigen::Vector3d d = off(p.pose);
    logs.push_back(pull.dot(d) - 0.5 * d.dot(learnt * d));
    most = std::max(most, logs.back());
  }
  for (std::size_t i = 0; i < particles_.size(); ++i)
    particles_[i].log_weight += std::max(kLeast, logs[i] - most);
}

void ParticleCloud::select() {
  const std::vector<double> weight = weights();
  double squares = 0.0;
  for (const double w : weight)
    squares += w * w;
  const auto count = static_cast<double>(particles_.size());
  if (squares * count < 2.0)
    return;
  // Each survives by its weight, with one random number for all.
  std::vector<Particle> next;
  next.reserve(particles_.size());
  std::size_t at = 0;
  double sum = weight[0];
  const double first = random_.uniform();
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    while (sum * count < static_cast<double>(i) + first && at + 1 < particles_.size())
      sum += weight[++at];
    next.push_back({particles_[at].pose, particles_[at].ahead, particles_[at].drift, 0.0});
  }
  particles_ = std::move(next);
}

Pose ParticleCloud::middle(const std::vector<double>& weight) const {
  Pose result;
  Vec2 heading{0.0, 0.0};
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const Particle& p = particles_[i];
    result.x += weight[i] * p.pose.x;
    result.y += weight[i] * p.pose.y;
    heading += weight[i] * p.ahead;
  }
  result.th = std::atan2(heading.y(), heading.x());
  return result;
}

ParticleCloud::Estimate ParticleCloud::estimate() {
  settle();
  Estimate result;
  const std::vector<double> weight = weights();
  result.pose = middle(weight);
  for (std::size_t i = 0; i < particles_.size(); ++i)
    result.drift += weight[i] * particles_[i].drift;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const Particle& p = particles_[i];
    const Eigen::Vector3d off(p.pose.x - result.pose.x, p.pose.y - result.pose.y,
                              norm2_angle(p.pose.th - result.pose.th));
    result.covariance += weight[i] * off * off.transpose();
    result.drift_variance += weight[i] * (p.drift - result.drift) * (p.drift - result.drift);
  }
  return result;
}

}  // namespace saphira::registration
