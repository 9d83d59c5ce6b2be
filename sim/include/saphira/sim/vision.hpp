#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "saphira/base/random.hpp"
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

/// A pair of cameras. The defaults are those of a head at breast height with a field of view of 60
/// degrees.
struct StereoCamera {
  Pose pose_in_robot;
  double height = 1.0;                   ///< [m] above the floor
  int columns = 80;                      ///< of each band
  double field_of_view = radians(60.0);  ///< [rad]
  /// [m] Heights above the floor of the three bands, at an adult's torso (Konolige and others 1996,
  /// 3.2.3).
  std::array<double, 3> bands{1.0, 1.2, 1.4};
  double baseline = 0.12;            ///< [m] between the cameras
  double disparity = radians(0.09);  ///< [rad] the least measurable one: a pixel
  double noise = 0.25;               ///< standard deviation of a disparity [the least one]
  double dropout = 0.05;             ///< probability that a column has no match
};

/// Ranges [m] along the camera's axis, from the left to the right; nothing without a match, or too
/// far for a disparity.
using RangeBand = std::vector<std::optional<double>>;

/// The result of a stereo system for the scene: a range for each column at three heights. Ranges
/// come in steps of disparity. `random` is the robot's own, for noise and missing matches.
std::array<RangeBand, 3> see_bands(const Scene& scene, RobotNumber robot,
                                   const StereoCamera& camera, Random& random);

}  // namespace saphira::sim
