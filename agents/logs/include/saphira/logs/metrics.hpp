#pragma once

#include <optional>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/logs/carmen.hpp"

namespace saphira::logs {

struct StampedPose {
  double time = 0.0;
  Pose pose;
};

/// Poses in the order of time; between them by dead reckoning, or straight.
class Trajectory {
 public:
  explicit Trajectory(std::vector<StampedPose> poses);

  /// Nothing before the first, after the last, or in a gap of more than `gap` seconds.
  std::optional<Pose> at(double time, double gap = 1e9) const;
  const std::vector<StampedPose>& poses() const { return poses_; }
  double length() const;

 private:
  std::vector<StampedPose> poses_;
};

/// Transfers the poses of scans to the stamps of a denser track: the track's motion from scan to
/// scan, bent so that it ends at the next scan's pose.
Trajectory densify(const Trajectory& scans, const Trajectory& odometry);

/// The systematic error of dead reckoning, as from a calibration drive.
struct OdometryErrors {
  double turn_per_metre = 0.0;  ///< [rad/m] missing turn
  double turn_scale = 1.0;      ///< true by measured
  double way_scale = 1.0;
};
/// The constants with the best fit over the whole way, by stretches of about a metre.
OdometryErrors fit_odometry(const std::vector<Pose>& odometry, const std::vector<Pose>& truth);
/// Dead reckoning without those errors.
std::vector<Pose> calibrated(const std::vector<Pose>& odometry, const OdometryErrors& errors);

struct Spread {
  double mean = 0.0;
  double deviation = 0.0;
  double squared = 0.0;  ///< mean square
  double median = 0.0;
  double most = 0.0;
  std::size_t count = 0;
};
Spread spread_of(const std::vector<double>& values);

struct RelationErrors {
  Spread translation;  ///< [m]
  Spread rotation;     ///< [rad]
  std::size_t missing = 0;
};

/// Kümmerle, Steder, Dornhege, Ruhnke, Grisetti, Stachniss, Kleiner: On measuring the accuracy of
/// SLAM algorithms, Autonomous Robots 2009. No alignment.
RelationErrors relation_errors(const Trajectory& estimate, const std::vector<Relation>& relations);

struct Pairs {
  std::vector<Pose> estimate;
  std::vector<Pose> reference;
};
/// The estimate at the reference's stamps, where both exist.
Pairs pair_up(const Trajectory& estimate, const Trajectory& reference);

/// Root mean square of the distances after the best rigid alignment (Umeyama, without scale) [m].
double ate_rmse(const Pairs& pairs);
/// The pose of the estimate's frame in the reference's, by the same alignment.
Pose alignment(const Pairs& pairs);

struct DriftErrors {
  Spread translation;  ///< [m]
  Spread rotation;     ///< [rad]
};
/// Errors of the relative pose over each stretch of `distance` metres of the reference.
DriftErrors drift(const Pairs& pairs, double distance);

}  // namespace saphira::logs
