#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "saphira/idl/system.hpp"
#include "saphira/idl/vision.hpp"
#include "saphira/viewer/picture.hpp"

namespace saphira::viewer {

/// A channel of messages that Foxglove, Lichtblick and others draw without configuration. The
/// schemas are those of Foxglove (npm: @foxglove/schemas).
struct DrawnChannel {
  const char* topic;
  const char* type;  ///< such as foxglove.Grid
};

/// Every channel of Scene; a message names its channel by the place in here.
std::span<const DrawnChannel> drawn_channels();
/// The JSON Schema of one of their types.
std::string drawn_schema(const std::string& type);

struct DrawnMessage {
  std::size_t channel;  ///< of drawn_channels()
  std::string json;
};

/// Translates the robot's topics for viewers. The frames are map, odom and base_link; lengths in
/// metres, angles as quaternions. `time_ns`: of the sample, since 1970.
class Scene {
 public:
  using Messages = std::vector<DrawnMessage>;

  /// The grid of echoes comes at most once in `grid_period` [s], since it is large.
  explicit Scene(double grid_period);

  /// Transforms, and the pose on the map; without a position on a map, in odom.
  Messages take(const v1::RobotState& state, std::int64_t time_ns);
  /// The robot's body.
  Messages take(const v1::RobotDescription& description, std::int64_t time_ns);
  /// The newest echo of each sonar as a point.
  static Messages take(const v1::SonarBuckets& sonars, std::int64_t time_ns);
  /// Walls and openings that are seen now.
  static Messages take(const v1::Perception& perception, std::int64_t time_ns);
  /// A tile of the grid, or its withdrawal. One message has the whole grid.
  Messages take(const v1::GridTile& tile, bool disposed, std::int64_t time_ns);
  /// The lines and names of the map.
  static Messages take(const v1::FloorMap& map, std::int64_t time_ns);
  /// No message: it places the next RobotState.
  void take(const v1::Registration& registration) { placing_.take(registration); }
  static Messages take(const v1::LogRecord& record);
  static Messages take(const v1::CameraPicture& picture, std::int64_t time_ns);

 private:
  Tiles tiles_;
  Placing placing_;
};

}  // namespace saphira::viewer
