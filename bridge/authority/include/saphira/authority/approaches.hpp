#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "saphira/authority/guard.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::authority {

/// One firing of a sonar.
struct Reading {
  int sonar = 0;
  Pose sonar_in_robot;
  std::optional<double> range;  ///< [m] of the echo; none: silence
};

/// Finds what comes towards the robot: an echo that has come nearer from one firing of a sonar to
/// its next, by more than the robot has moved and no faster than people run, to where nothing was
/// known to stand. A ring of sonars has gaps, so what has come is remembered for some seconds.
class Approaches {
 public:
  /// A reading of this cycle. `known_in_robot` is where something is known to be.
  void hear(std::uint64_t cycle, const Pose& robot_in_odom, const Reading& reading,
            const std::vector<Vec2>& known_in_robot);
  void clear();

  /// What comes, where it is now if it comes on; after a second it is taken to stand there.
  std::vector<Approach> now(std::uint64_t cycle, const Pose& robot_in_odom) const;

 private:
  struct Firing {
    std::uint64_t cycle = 0;
    Pose sonar_in_odom;
    std::optional<double> range;
  };
  struct Came {
    std::uint64_t cycle = 0;
    Vec2 at_in_odom{0.0, 0.0};
    double closing = 0.0;  ///< [m/s]
  };

  std::map<int, Firing> fired_;  ///< the newest of each sonar
  std::map<int, Came> came_;     ///< the newest of each sonar
  std::uint64_t began_ = 0;      ///< the cycle in which the newest alarm began; 0: none yet
  std::deque<Came> noticed_;     ///< of the last half minute
};

}  // namespace saphira::authority
