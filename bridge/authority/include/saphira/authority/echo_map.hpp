#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "saphira/geometry/edge.hpp"
#include "saphira/geometry/pose.hpp"
#include "saphira/lps/obstacle_memory.hpp"

namespace saphira::authority {

/// One firing of a sonar.
struct Reading {
  int sonar = 0;
  Pose sonar_in_robot;
  std::optional<double> range;  ///< [m] of the echo; none: silence
};

/// Echoes of the sonars round the robot. An echo comes from somewhere on an arc across its sonar's
/// axis, and an object that enters the gap between two beams is still there. The memory is that of
/// the behaviors (saphira/lps). It forgets only where a beam looks, and while the robot drives
/// away. An echo at the distance of a known edge is the edge's; any other may be a person's.
class EchoMap {
 public:
  /// Of sonars that hear up to `sonar_range` [m]. Echoes from farther away than 2.5 m do not
  /// matter.
  explicit EchoMap(double sonar_range = 5.0);

  /// A packet came, with these new readings in firing order, this pose of the robot, and the edges
  /// [odom] that its driver knows.
  void update(std::uint64_t cycle, const Pose& robot_in_odom, const std::vector<Reading>& readings,
              const std::vector<Edge>& edges = {});
  void clear();

  /// Positions of the remembered echoes, in the robot's frame as of the last update: those that may
  /// be a person's...
  const std::vector<Vec2>& spots() const { return memory_.points(); }
  /// ...and those of known edges.
  const std::vector<Vec2>& edges() const { return edges_.points(); }
  /// True where some sonar within 60 degrees of straight ahead (or back) has fired in the last
  /// second (a Pioneer's sonars fire every third cycle). At first no sonar has had its turn.
  bool sees(std::uint64_t cycle, bool ahead) const;

  /// The newest firing whose arc passes through a spot.
  struct Firing {
    int sonar = 0;
    std::uint64_t ago = 0;  ///< [cycles] before the last update
  };
  std::optional<Firing> heard(const Vec2& spot) const;

  template <class Archive>
  void archive(Archive& a) {
    a("range", range_);
    if (a.restores())
      *this = EchoMap(range_);
    a("memory", memory_)("edges", edges_)("robot_in_odom", robot_in_odom_)("cycle", cycle_)(
        "echoes", echoes_)("fired_ahead", fired_ahead_)("fired_behind", fired_behind_);
  }

 private:
  struct Echo {
    int sonar = 0;
    Pose sonar_in_odom;
    double range = 0.0;       ///< [m]
    std::uint64_t cycle = 0;  ///< of the update
  };

  double range_;
  lps::ObstacleMemory memory_;
  lps::ObstacleMemory edges_;
  Pose robot_in_odom_;
  std::uint64_t cycle_ = 0;
  std::deque<Echo> echoes_;        ///< oldest first
  std::uint64_t fired_ahead_ = 0;  ///< the newest cycle in which such a sonar fired
  std::uint64_t fired_behind_ = 0;
};

}  // namespace saphira::authority
