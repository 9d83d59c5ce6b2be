#pragma once

#include <array>
#include <optional>
#include <vector>

#include "saphira/vision/sight.hpp"

namespace saphira::vision {

/// The report of a Fast Track camera on one channel (manual 9.2). Pixels, from the picture's
/// middle; x is positive to the right, y up.
struct Patch {
  int x = 0;  ///< centre of mass
  int y = 0;
  int area = 0;   ///< [pixels] 0: nothing of that colour
  int width = 0;  ///< of the box around it; 0: unknown
  int height = 0;
};
using Channels = std::array<Patch, 3>;

/// The Fast Track camera, as mounted; pixels by manual 9.2.
struct ColorCamera {
  double forward = 0.15;              ///< [m] before the robot's centre
  double height = 0.35;               ///< [m] above the floor
  double pixel = radians(1.0) / 3.0;  ///< [rad]
  int columns = 160;                  ///< [pixels]
  int rows = 120;                     ///< [pixels]
  /// [m] The height of a channel's objects, if known: it gives their range.
  std::array<std::optional<double>, 3> heights{};
};

/// The places of the patches: with a known height by their elevation; otherwise a patch that
/// reaches below the horizon counts as standing on the floor, and its foot gives the range. Of
/// others only the direction is known.
std::vector<Sight> find_blobs(const Channels& channels, const ColorCamera& camera = {});

/// True where that camera would see an object at that place.
bool in_view(const ColorCamera& camera, const Vec2& place_in_robot);

}  // namespace saphira::vision
