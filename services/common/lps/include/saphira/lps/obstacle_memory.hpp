#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::lps {

/// The belief in obstacles. Beliefs are log odds: 0 is "unknown".
struct MemorySettings {
  double cell = 0.05;           ///< [m]
  int cells = 120;              ///< along each side; the robot is near the middle
  double beam = radians(12.5);  ///< [rad] half angle of a sonar's cone
  double sure = radians(4.0);   ///< [rad] within which an object surely has an echo
  double thickness = 0.05;      ///< [m] error of an echo's range
  double seen = 1.5;            ///< added at an echo
  double passed = 0.6;          ///< subtracted along a beam with an echo
  double silent = 0.4;          ///< subtracted along a beam without an echo
  double silent_range = 1.0;    ///< [m] up to which silence counts
  double most = 4.0;            ///< no belief grows above this...
  double least = -4.0;          ///< ...or below this
  double obstacle = 0.8;        ///< belief that makes an obstacle
  double fading = 0.97;         ///< of all beliefs, a cycle: 4 are forgotten in 6 s
  bool keeps_at_rest = false;   ///< none fades while the robot stands or turns
};

/// The settings for sonars that hear up to `range` [m]. Below 1 m the grid is finer, since a cone
/// so short holds few cells or none. Silence says nothing of what is out of range.
MemorySettings for_range(double range, MemorySettings settings = {});

/// The places of a grid's cells, as seen from a frame, are sums: of a part for the column...
struct ColumnParts {
  std::vector<float> x;  ///< [m]
  std::vector<float> y;
};
/// ...and of one for the row: here the cells of a row that a sonar's cone may cover.
struct ConeRow {
  long number = 0;
  long begin = 0;  ///< columns
  long end = 0;
  double dx = 0.0;  ///< [m] from the sonar to the first cell, in odom
  double dy = 0.0;
  float x = 0.0F;  ///< [m] the row's part
  float y = 0.0F;
};

/// The obstacles that the sonars have seen around the robot, until later readings contradict them.
///
/// The manual's buffers forget by count: an obstacle that leaves the front sonars' sight while the
/// robot rounds it (a Pioneer sees nothing between 45 and 75 degrees) leaves the front buffer after
/// 1.7 s, and the robot turns into it. The buffers also put an echo on the axis of the beam, while
/// it comes from somewhere on the arc across: a gap of a metre looks closed from a metre off. Here
/// each beam counts for its whole cone, in a grid that goes with the robot: the cone up to the arc
/// is free, and the obstacle is on the arc, more likely where it was likely before (Moravec and
/// Elfes 1985). Silence counts less than an echo from behind, and not at all far away, since a
/// smooth wall at a slant is silent too. An echo from behind counts little at the rim of its cone,
/// since it may come from a corner along such a wall.
class ObstacleMemory {
 public:
  explicit ObstacleMemory(MemorySettings settings = {});

  /// A beam from `sonar_in_odom` along its heading met something at `range` [m].
  void echo(const Pose& sonar_in_odom, double range);
  /// A beam met nothing.
  void silence(const Pose& sonar_in_odom);
  /// A beam was free up to an echo at `range` [m], which another memory takes.
  void free_before(const Pose& sonar_in_odom, double range);
  /// The robot has hit an obstacle here.
  void touch(const Vec2& at_in_odom);
  /// A cycle has passed, with this pose of the robot: before the beams of the cycle.
  void move_to(const Pose& robot_in_odom);
  /// Registers the obstacles with the robot: after the beams of the cycle.
  void collect(const Pose& robot_in_odom);
  void clear();

  /// The cells that hold an obstacle, in the robot's frame as of the last collect.
  const std::vector<Vec2>& points() const { return points_; }

  template <class Archive>
  void archive(Archive& a) {
    const std::size_t cells = beliefs_.size();
    a("placed", placed_)("robot_in_odom", robot_in_odom_)("column", column0_)("row", row0_)(
        "beliefs", beliefs_)("held", held_)("unit", unit_)("marks", marks_)("points", points_);
    a.expect(beliefs_.size() == cells, "a grid of that size");
  }

 private:
  /// A cell of the arc of an echo.
  struct Arc {
    long row;
    long column;
    float likely;
  };

  /// Columns of a row.
  struct Part {
    void widen(long from, long to) {
      *this = begin == end ? Part{from, to} : Part{std::min(begin, from), std::max(end, to)};
    }
    long begin = 0;
    long end = 0;
  };

  /// Computes the parts of some columns.
  void see_columns(const Pose& frame, double cosine, double sine, long begin, long end);
  /// Puts the cells into cone_ that a cone may cover, up to `range`. `only_held`: not in rows
  /// without beliefs above 0.
  void look_along(const Pose& sonar_in_odom, double range, bool only_held);
  /// Lowers the beliefs of cone_ up to `range`.
  void pass(double range, double doubt);
  void pass(const Pose& sonar_in_odom, double range, double doubt);
  /// Puts the cells of cone_ at an echo's range into arc_.
  void find_arc(double range);
  void shift(long columns, long rows);
  void fade();
  void put(long row, long column, float belief);
  std::size_t index(long row, long column) const {
    return static_cast<std::size_t>(row * settings_.cells + column);
  }

  MemorySettings settings_;
  double edge_;  ///< tangent of the cone's half angle
  double soft_;  ///< share of the cone, from its rim, in which an object may have no echo
  bool placed_ = false;
  Pose robot_in_odom_;  ///< of the last move_to
  long column0_ = 0;    ///< of the grid's corner, in cells of odom
  long row0_ = 0;
  std::vector<float> beliefs_;        ///< by rows, in units
  std::vector<Part> held_;            ///< by row: no other belief is above 0
  float unit_ = 1.0F;                 ///< a belief of 1, as it is stored
  std::size_t words_;                 ///< of marks, in a row
  std::vector<std::uint64_t> marks_;  ///< bits by cell: all obstacles, until the next collect more
  ColumnParts columns_;               ///< seen from the sonar or the robot
  std::vector<ConeRow> cone_;
  std::vector<Arc> arc_;
  std::vector<Vec2> points_;
};

}  // namespace saphira::lps
