#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

#include "saphira/authority/echo_map.hpp"
#include "saphira/base/archived.hpp"
#include "saphira/protocol/parameters.hpp"

namespace saphira::authority {

/// [rad] A post of 5 cm and a shin have a dependable echo this far off a sonar's axis, from 0.3 m
/// to 1.5 m (sim/README.md, "Sonar echoes").
inline constexpr double kLobe = radians(8.0);

/// The spots that the main lobes of the sonars have covered lately. Sonars of many robots leave
/// gaps between their lobes, some of them straight ahead.
class Coverage {
 public:
  /// For a hull of this radius [m] and sonars that hear up to `range` [m].
  explicit Coverage(double radius = 0.0, double range = 5.0)
      : radius_(radius), range_(std::min(range, kDependable)) {}

  /// A packet came, with these new readings and this pose of the robot.
  void update(std::uint64_t cycle, const Pose& robot_in_odom, const std::vector<Reading>& readings);

  void clear() { lobes_.clear(); }

  /// [m] from the hull along its straight path, forward or back, to the first spot that no lobe has
  /// covered in the last four seconds. At most the range; infinite for sonars that hear less than
  /// 0.35 m.
  double way(bool forward) const;

  SAPHIRA_ARCHIVE(radius_, range_, robot_in_odom_, lobes_)

 private:
  struct Lobe {
    ToFrame to_sonar{Pose{}};
    double range = 0.0;  ///< [m] up to which nothing was heard
    std::uint64_t cycle = 0;
  };
  static bool covers(const Lobe& lobe, const Vec2& spot_in_odom);

  static constexpr double kDependable = 1.5;  ///< [m]
  double radius_;
  double range_;
  Pose robot_in_odom_;
  std::deque<Lobe> lobes_;  ///< newest first
};

/// [rad] The robot has to swing to either side by this angle, so that the lobes of its sonars cover
/// the gaps between them within 20 degrees of its way, forward or back. 0: there is no gap, or one
/// wider than 20 degrees.
double swing(const std::vector<protocol::SonarUnit>& sonars, bool forward);

}  // namespace saphira::authority
