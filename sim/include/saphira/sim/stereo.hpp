#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saphira/base/random.hpp"
#include "saphira/geometry/pose.hpp"
#include "saphira/sim/scene.hpp"

namespace saphira::sim {

/// A grey picture, its rows from the top.
struct GreyImage {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> pixels;

  std::uint8_t at(int column, int row) const {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(column)];
  }
};

/// Two pinhole cameras side by side, parallel to each other and to the floor; a head may turn them.
/// A point at depth z [m] is focal() * baseline / z pixels farther to the left in the right
/// picture than in the left one. Pictures as large as Flakey's (Konolige and others 1996, Figure
/// 3); the paper gives no other figures, so the rest is that of StereoCamera.
struct StereoRig {
  Pose pose_in_robot;                    ///< of the middle between the two
  double height = 1.0;                   ///< [m] above the floor
  int columns = 320;                     ///< of each picture
  int rows = 240;                        ///< [pixels]
  double field_of_view = radians(60.0);  ///< [rad] from side to side
  double baseline = 0.12;                ///< [m]
  double noise = 2.0;                    ///< standard deviation of a pixel, in steps of 1/255
  double gain_difference = 0.04;         ///< relative brightness of the right camera's pictures
  double range = 30.0;                   ///< [m] farther surfaces are grey

  double focal() const;  ///< [pixels]
};

struct StereoPair {
  GreyImage left;
  GreyImage right;
};

/// The pictures of the two cameras of a robot: walls, doors, people, boxes, posts, other robots,
/// floor and ceiling, each with its own fixed texture, so that a point of the world looks alike in
/// both. People are a body with a head, and an arm while they point. No shadows, no mirrors, no
/// blur. `random` is for the noise of the pixels alone.
StereoPair render_stereo(const Scene& scene, RobotNumber robot, const StereoRig& rig,
                         Random& random);

/// A pair as one picture in the format PGM, the left one on the left, with the parameters for
/// ranges in a comment:
/// "# saphira stereo cycle=12 focal=277.128 baseline=0.12 height=1 forward=0 pan=0".
std::string to_pgm(const StereoPair& pair, const StereoRig& rig, std::uint64_t cycle);

}  // namespace saphira::sim
