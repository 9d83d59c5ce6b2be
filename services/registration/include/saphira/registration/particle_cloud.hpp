#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/base/random.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::registration {

struct CloudSettings {
  std::size_t particles = 150;
  // Dead reckoning, one sigma. Larger than for a sound robot: the cloud is for the others.
  double way = 0.06;                 ///< [m] after 1 m
  double turn = 0.08;                ///< [rad] after a turn of 1 rad
  double heading = radians(1.5);     ///< [rad] after 1 m
  double drift = radians(2.0);       ///< [rad/m] error of a constant turn...
  double drift_walk = radians(0.3);  ///< [rad/m] ...and its change in 1 m

  double least_position = 0.1;         ///< [m] one sigma at the start, at least...
  double least_turned = radians(4.0);  ///< [rad] ...and of the heading
};

/// Possible poses of the robot near the estimated one, each with its own drift of dead reckoning;
/// poses that the readings make unlikely die out (Monte Carlo localization, Dellaert et al. 1999).
/// The cloud holds where dead reckoning errs more than a filter of one pose may assume, or where
/// the map has few recognizable walls. The filter is more exact where it holds. The same calls give
/// the same poses.
class ParticleCloud {
 public:
  explicit ParticleCloud(CloudSettings settings) : settings_(settings) {}

  void begin(const Pose& pose, const Eigen::Matrix3d& covariance, double drift, double drift_sigma);
  void clear() { particles_.clear(); }
  bool empty() const { return particles_.empty(); }

  /// The robot's motion by dead reckoning, in its own earlier frame.
  void move(const Pose& moved);
  /// Weighs the poses by a reading of a sonar at `sensor_in_robot`. `worth` is a function of the
  /// sensor's place in the map, and of the unit vector along its axis.
  template <typename Worth>
  void weigh(const Pose& sensor_in_robot, Worth&& worth) {
    settle();
    const Vec2 axis = sensor_in_robot.direction();
    for (Particle& p : particles_) {
      const Vec2 left(-p.ahead.y(), p.ahead.x());
      p.log_weight +=
          worth(p.pose.position() + sensor_in_robot.x * p.ahead + sensor_in_robot.y * left,
                axis.x() * p.ahead + axis.y() * left);
    }
  }
  /// Applies a filter's correction between these two poses to all particles.
  void learn(const Pose& before, const Eigen::Matrix3d& covariance_before, const Pose& after,
             const Eigen::Matrix3d& covariance_after);
  /// Resamples when there are too many unlikely particles.
  void select();

  struct Estimate {
    Pose pose;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< x, y, th
    double drift = 0.0;                                    ///< [rad/m]
    double drift_variance = 0.0;
  };
  Estimate estimate();
  /// The pose of the estimate.
  Pose middle() {
    settle();
    return middle(weights());
  }

  SAPHIRA_ARCHIVE(random_, moved_, length_, turned_, particles_)

 private:
  struct Particle {
    Pose pose;
    Vec2 ahead{1.0, 0.0};  // along the heading
    double drift = 0.0;
    double log_weight = 0.0;
  };
  /// Applies the motion since the last call to the particles.
  void settle();
  /// Nearly normal, with a deviation of 1; never beyond 3.5.
  double noise();
  std::vector<double> weights() const;
  Pose middle(const std::vector<double>& weight) const;

  CloudSettings settings_;
  Random random_{1};
  // Since the particles moved:
  Pose moved_;
  double length_ = 0.0;  ///< [m] of way...
  double turned_ = 0.0;  ///< [rad] ...and of turns, either way
  std::vector<Particle> particles_;
};

}  // namespace saphira::registration
