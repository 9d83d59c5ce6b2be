#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::lps {

/// How long and how firmly obstacles are remembered.
struct MemorySettings {
  std::uint64_t kept_cycles = 100;  ///< since it was seen last
  double kept_distance = 3.0;       ///< [m] from the robot
  std::size_t capacity = 400;       ///< the oldest goes
  double same_place = 0.08;         ///< [m] echoes so near to each other are one obstacle
  double beam = radians(8.0);       ///< [rad] half angle within which a beam would surely have hit
  double margin = 0.25;             ///< [m] a beam ends so far behind what it disproves
};

/// What the sonars have seen around the robot, for as long as nothing speaks against it.
///
/// The manual's buffers forget by count: an obstacle that leaves the front sonars' sight while the
/// robot rounds it (a Pioneer sees nothing between 45 and 75 degrees) is gone from the front buffer
/// after 1.7 s, and the robot turns into it. Here an echo is believed until it is old or far, or
/// until later beams have passed through its place: an echo from behind it disproves more than
/// silence does, since a smooth wall met at a slant is silent too.
class ObstacleMemory {
 public:
  explicit ObstacleMemory(MemorySettings settings = {}) : settings_(settings) {}

  /// A beam from `sonar_in_odom` along its heading met something at `range` [m].
  void echo(const Pose& sonar_in_odom, double range, std::uint64_t cycle);
  /// A beam met nothing within `range` [m].
  void silence(const Pose& sonar_in_odom, double range);
  /// Forgets what is old or far, and registers the rest with the robot.
  void update(const Pose& robot_in_odom, std::uint64_t cycle);
  void clear();

  /// In the robot's frame as of the last update.
  const std::vector<Vec2>& points() const { return in_robot_; }

 private:
  struct Obstacle {
    Vec2 in_odom;
    std::uint64_t seen;
    int belief;
  };
  void disprove(const Pose& sonar_in_odom, double range, int doubt);

  MemorySettings settings_;
  std::vector<Obstacle> obstacles_;
  std::vector<Vec2> in_robot_;
};

}  // namespace saphira::lps
