#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "saphira/ros2/messages.hpp"
#include "saphira/situation/situation.hpp"
#include "saphira/viewer/picture.hpp"

namespace saphira::ros2 {

/// Messages for ROS 2, each for the topic of its name (messages.hpp). Frames: map, odom, base_link,
/// and sonar_N of each sonar.
struct Messages {
  std::optional<Odometry> odom;
  std::optional<TFMessage> tf;
  std::optional<TFMessage> tf_static;
  std::optional<PoseWithCovarianceStamped> pose;
  std::optional<OccupancyGrid> map;
  std::optional<OccupancyGrid> local_map;
  std::vector<Range> sonar;
  std::optional<PointCloud2> echoes;
  std::optional<BatteryState> battery;
  std::optional<Path> path;
  std::optional<MarkerArray> markers;
  std::optional<MarkerArray> map_markers;
  std::optional<DiagnosticArray> diagnostics;
};

Time time_of(std::int64_t time_ns);
Pose3 pose_of(const v1::Pose2& pose);

/// Translates the robot's topics for ROS 2. `time_ns`: of the sample, since 1970.
class Outward {
 public:
  /// with_map: the map, and where odom is on it; else another program gives them, such as
  /// slam_toolbox.
  explicit Outward(bool with_map) : with_map_(with_map) {}

  /// Odometry, transforms, new readings; once a second the battery and the path.
  Messages take(const v1::RobotState& state, std::int64_t time_ns);
  /// The frames of the sonars, and the robot's body.
  Messages take(const v1::RobotDescription& description, std::int64_t time_ns);
  Messages take(const v1::Registration& registration, std::int64_t time_ns);
  Messages take(const v1::FloorMap& map, std::int64_t time_ns) const;
  Messages take(const v1::GridTile& tile, bool disposed, std::int64_t time_ns);
  static Messages take(const v1::SonarBuckets& sonars, std::int64_t time_ns);
  static Messages take(const v1::Perception& perception, std::int64_t time_ns);
  /// The reason for the robot's motion, above it.
  static Messages why(const std::string& sentence, std::int64_t time_ns);
  static Messages diagnostics(const situation::Situation& situation, std::int64_t time_ns);

  /// The newest place of the robot [none: no RobotState came].
  const std::optional<viewer::Place>& place() const { return place_; }

 private:
  bool with_map_;
  viewer::Placing placing_;
  viewer::Tiles tiles_{1.0};
  std::optional<viewer::Place> place_;
  std::uint64_t odom_ = 0;
  Path path_;
  std::int64_t slow_ns_ = 0;
};

}  // namespace saphira::ros2
