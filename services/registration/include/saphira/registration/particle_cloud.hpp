#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "saphira/base/random.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::registration {

struct CloudSettings {
  std::size_t particles = 150;
  // Dead reckoning, one sigma. More than that of a sound robot: the cloud is there for the others.
  double way = 0.06;                 ///< [m] after 1 m
  double turn = 0.08;                ///< [rad] after a turn of 1 rad
  double heading = radians(1.5);     ///< [rad] after 1 m
  double drift = radians(2.0);       ///< [rad/m] constant turn that is not there...
  double drift_walk = radians(0.3);  ///< [rad/m] ...and by which it changes in 1 m

  double least_position = 0.1;         ///< [m] one sigma at the start, at least...
  double least_turned = radians(4.0);  ///< [rad] ...and of the heading

  bool operator==(const CloudSettings&) const = default;
};

/// Many poses that the robot could have, near the one that is believed, each with a drift of dead
/// reckoning of its own; what the readings make unlikely dies out (Monte Carlo localization,
/// Dellaert et al. 1999). It holds where dead reckoning errs more than a filter of one pose may
/// assume, or where the map has few walls that are seen as such; the filter is more exact where it
/// holds. The same calls give the same poses.
class ParticleCloud {
 public:
  explicit ParticleCloud(CloudSettings settings) : settings_(settings) {}

  void begin(const Pose& pose, const Eigen::Matrix3d& covariance, double drift, double drift_sigma);
  void clear() { particles_.clear(); }
  bool empty() const { return particles_.empty(); }

  /// The robot has moved so, by dead reckoning, in its own frame before.
  void move(const Pose& moved);
  /// A reading of a sonar at `sensor_in_robot` is worth so much at each pose. `worth` is a function
  /// of the sensor's pose in the map.
  template <typename Worth>
  void weigh(const Pose& sensor_in_robot, Worth&& worth) {
    for (Particle& p : particles_)
      p.log_weight += worth(compose(p.pose, sensor_in_robot));
  }
  /// Gives all particles the correction that a filter made between these two poses.
  void learn(const Pose& before, const Eigen::Matrix3d& covariance_before, const Pose& after,
             const Eigen::Matrix3d& covariance_after);
  /// Lets the unlikely ones die when there are too many of them.
  void select();

  struct Estimate {
    Pose pose;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< x, y, th
    double drift = 0.0;                                    ///< [rad/m]
    double drift_variance = 0.0;
  };
  Estimate estimate() const;

  bool operator==(const ParticleCloud&) const = default;

 private:
  struct Particle {
    Pose pose;
    double drift = 0.0;
    double log_weight = 0.0;

    bool operator==(const Particle&) const = default;
  };
  std::vector<double> weights() const;

  CloudSettings settings_;
  Random random_{1};
  std::vector<Particle> particles_;
};

}  // namespace saphira::registration
