#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "saphira/vision/sight.hpp"

namespace saphira::vision {

/// The report of a Fast Track camera on one channel (manual 9.2). Pixels, from the picture's
/// middle; x is positive to the right, y up.
struct Patch {
  int x = 0;  ///< centre of mass
  int y = 0;
  int area = 0;   ///< [pixels] 0: nothing of that colour
  int width = 0;  ///< of the box around it; 0: not said
  int height = 0;
};
using Channels = std::array<Patch, 3>;

/// That camera, as it is mounted; pixels by manual 9.2.
struct ColorCamera {
  double forward = 0.15;              ///< [m] before the robot's centre
  double height = 0.35;               ///< [m] above the floor
  double pixel = radians(1.0) / 3.0;  ///< [rad]
  int columns = 160;                  ///< [pixels]
  int rows = 120;                     ///< [pixels]
  /// [m] How high the things of a channel are, where that is known: then their range is.
  std::array<std::optional<double>, 3> heights{};
};

/// Where the patches are: of known height, by how high they look; else, what reaches below the
/// horizon is taken to stand on the floor, and its foot tells the range. Of others only the
/// direction is known.
std::vector<Sight> find_blobs(const Channels& channels, const ColorCamera& camera = {});

/// True where that camera would see something there.
bool in_view(const ColorCamera& camera, const Vec2& place_in_robot);

}  // namespace saphira::vision
