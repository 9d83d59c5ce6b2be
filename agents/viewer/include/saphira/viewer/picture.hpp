#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/idl/map.hpp"
#include "saphira/idl/perception.hpp"
#include "saphira/idl/robot.hpp"

/// The parts of a picture of the robot, for viewers of every kind.
namespace saphira::viewer {

struct Line {
  Vec2 from;
  Vec2 to;
};

struct Label {
  std::string text;
  v1::Pose2 at;
};

/// Lines on the floor, in the frame of the artifact or percept.
struct Plan {
  std::vector<Line> walls;
  std::vector<Line> openings;  ///< doors, breaks, junctions
  std::vector<Label> names;    ///< of places
};

/// The outlines of the present percepts, in odom.
Plan plan_of(const v1::Perception& perception);
/// Of the map.
Plan plan_of(const v1::FloorMap& map);

/// The newest echo of each sonar in odom: x, y and z of each as floats of this machine.
std::string echoes_of(const v1::SonarBuckets& sonars);
inline constexpr std::size_t kEchoBytes = 3 * sizeof(float);

/// Where the robot is.
struct Place {
  std::optional<v1::Pose2> odom_in_map;  ///< while the position on the map is known
  v1::Pose2 pose;                        ///< of the robot in map, else in odom
};

class Placing {
 public:
  void take(const v1::Registration& registration);
  Place of(const v1::RobotState& state) const;

 private:
  std::optional<v1::Registration> registration_;  // tracking
};

/// An occupancy grid in odom.
struct Cells {
  std::uint64_t odom = 0;  ///< of which dead-reckoning frame
  double x = 0.0;          ///< [m] of its corner
  double y = 0.0;
  double resolution = 0.0;  ///< [m]
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::string cells;  ///< by rows, from the smallest y: as in GridTile
};

/// Puts the tiles of the grid together.
class Tiles {
 public:
  /// The grid comes at most once in `period` [s], since it is large.
  explicit Tiles(double period);
  /// A tile, or its withdrawal.
  std::optional<Cells> take(const v1::GridTile& tile, bool disposed, std::int64_t time_ns);
  /// The same in two steps, whenever it is wanted. Nothing: there is no tile, or they are too far
  /// apart for one grid.
  void note(const v1::GridTile& tile, bool disposed);
  std::optional<Cells> whole() const;
  bool empty() const { return tiles_.empty(); }

 private:
  std::int64_t period_ns_;
  std::int64_t sent_ns_ = 0;
  std::map<std::pair<std::int32_t, std::int32_t>, v1::GridTile> tiles_;  // by row and column
};

}  // namespace saphira::viewer
