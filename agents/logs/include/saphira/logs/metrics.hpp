#pragma once

#include <optional>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::logs {

struct StampedPose {
  double time = 0.0;
  Pose pose;
};

/// Poses in the order of time; between them by dead reckoning, or straight.
class Trajectory {
 public:
  explicit Trajectory(std::vector<StampedPose> poses);

  /// Nothing before the first and after the last.
  std::optional<Pose> at(double time) const;
  const std::vector<StampedPose>& poses() const { return poses_; }
  double length() const;

 private:
  std::vector<StampedPose> poses_;
};

struct Pairs {
  std::vector<Pose> estimate;
  std::vector<Pose> reference;
};
/// The estimate at the reference's stamps, where both exist.
Pairs pair_up(const Trajectory& estimate, const Trajectory& reference);

/// The middle one in size; 0 without values.
double median(std::vector<double> values);

/// Root mean square of the distances after the best rigid alignment (Umeyama, without scale) [m].
double ate_rmse(const Pairs& pairs);
/// The pose of the estimate's frame in the reference's, by the same alignment.
Pose alignment(const Pairs& pairs);

struct DriftErrors {
  double translation = 0.0;  ///< [m]
  double rotation = 0.0;     ///< [rad]
};
/// Median errors of the relative pose over each stretch of `distance` metres of the reference.
DriftErrors drift(const Pairs& pairs, double distance);

}  // namespace saphira::logs
