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

/// A pinhole camera, parallel to the floor; a head may turn it. Pictures as large as Flakey's
/// (Konolige and others 1996, Figure 3); the paper gives no other figures.
struct PinholeCamera {
  Pose pose_in_robot;
  double height = 1.0;                   ///< [m] above the floor
  int columns = 320;                     ///< [pixels]
  int rows = 240;                        ///< [pixels]
  double field_of_view = radians(60.0);  ///< [rad] from side to side
  double noise = 2.0;                    ///< standard deviation of a pixel, in steps of 1/255
  double texture = 1.0;                  ///< share of the surfaces' texture that it shows
  double range = 30.0;                   ///< [m] farther surfaces are grey

  double focal() const;  ///< [pixels]
};

/// Two cameras side by side, parallel to each other. A point at depth z [m] is
/// focal() * baseline / z pixels farther to the left in the right picture than in the left one.
struct StereoRig : PinholeCamera {  ///< pose_in_robot: of the middle between the two
  double baseline = 0.12;           ///< [m]
  double gain_difference = 0.04;    ///< relative brightness of the right camera's pictures
};

/// A picture in colour: rows from the top, three octets a pixel (red, green, blue).
struct ColorImage {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> pixels;
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

/// The same scene in colour, for people: painted walls, wooden doors, clothes. Things have the
/// color of their file.
ColorImage render_picture(const Scene& scene, RobotNumber robot, const PinholeCamera& camera,
                          Random& random);

/// A pair as one picture in the format PGM, the left one on the left, with the parameters for
/// ranges in a comment:
/// "# saphira stereo cycle=12 focal=277.128 baseline=0.12 height=1 forward=0 pan=0".
std::string to_pgm(const StereoPair& pair, const StereoRig& rig, std::uint64_t cycle);

/// A picture in the format PPM, likewise: "# saphira picture cycle=12 field=1.0472 height=1
/// forward=0 pan=0".
std::string to_ppm(const ColorImage& image, const PinholeCamera& camera, std::uint64_t cycle);

}  // namespace saphira::sim
