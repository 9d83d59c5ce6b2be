#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::camera {

/// A picture as a camera gives it: rows from the top, three octets a pixel (red, green, blue).
struct Frame {
  std::uint64_t cycle = 0;     ///< of the robot's information packet [0: not known]
  int columns = 0;             ///< [pixels]
  int rows = 0;                ///< [pixels]
  double field_of_view = 0.0;  ///< [rad] from side to side [0: not known]
  double height = 0.0;         ///< [m] of the lens above the floor [0: not known]
  Pose pose_in_robot;          ///< of the lens; the heading is that of the picture's middle
  std::vector<std::uint8_t> pixels;
};

/// Makes frames of a stream of PPM files with the comment of sim/README.md.
class PpmStream {
 public:
  void feed(std::string_view bytes) { waiting_ += bytes; }
  /// The newest complete frame; earlier ones are dropped. FileError where the stream is another
  /// one.
  std::optional<Frame> take();

 private:
  std::optional<Frame> next();
  std::string waiting_;
};

/// `quality`: [1..100]. std::runtime_error where it cannot be.
std::vector<std::uint8_t> to_jpeg(const Frame& frame, int quality);
/// With its pixels and size alone. std::runtime_error where it is no JPEG.
Frame from_jpeg(const std::vector<std::uint8_t>& jpeg);

}  // namespace saphira::camera
