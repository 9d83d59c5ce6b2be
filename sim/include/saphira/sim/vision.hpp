#pragma once

#include <optional>
#include <string_view>

#include "saphira/geometry/pose.hpp"
#include "saphira/sim/scene.hpp"

namespace saphira::sim {

/// A camera that looks straight ahead. The defaults are those of the Fast Track system
/// (manual 9.2): about three pixels a degree.
struct Camera {
  Pose pose_in_robot{0.15, 0.0, 0.0};
  double height = 0.35;               ///< [m] above the floor
  int columns = 160;                  ///< [pixels]
  int rows = 120;                     ///< [pixels]
  double pixel = radians(1.0) / 3.0;  ///< [rad]
  double range = 10.0;                ///< [m] nothing is seen beyond
};

/// A patch of one color, in the camera's picture: [pixels] from its middle, x to the right, y up
/// (manual 9.2 gives no directions). The whole is the content of the Fast Track's BLOB_BB_MODE for
/// a channel.
struct Blob {
  int x = 0;  ///< centre of mass
  int y = 0;
  int area = 0;   ///< [pixels]
  int width = 0;  ///< of the bounding box
  int height = 0;
  bool operator==(const Blob&) const = default;
};

/// The largest visible patch of that color; nothing without one. Things have their full height and
/// hide others behind them.
std::optional<Blob> see_blob(const Scene& scene, RobotNumber robot, const Camera& camera,
                             std::string_view color);

}  // namespace saphira::sim
