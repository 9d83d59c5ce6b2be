#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace saphira::vision {

/// A view of a grey picture, its rows from the top.
struct ImageView {
  const std::uint8_t* pixels = nullptr;
  int columns = 0;
  int rows = 0;
  int stride = 0;  ///< [bytes] from a row to the next

  const std::uint8_t* row(int index) const {
    return pixels + static_cast<std::ptrdiff_t>(index) * stride;
  }
};

/// Two parallel pinhole cameras side by side, level with the floor.
struct Rig {
  double focal = 277.128129;  ///< [pixels]
  double baseline = 0.12;     ///< [m]
  double height = 1.0;        ///< [m] above the floor
  double forward = 0.0;       ///< [m] before the robot's centre
  double pan = 0.0;           ///< [rad] from straight ahead, to the left, about the middle of both

  bool operator==(const Rig&) const = default;
};

/// The pictures of both cameras in one cycle: side by side, the left one first.
struct StereoPicture {
  std::uint64_t cycle = 0;
  Rig rig;
  int columns = 0;  ///< of each picture
  int rows = 0;
  std::vector<std::uint8_t> pixels;

  ImageView left() const { return {pixels.data(), columns, rows, 2 * columns}; }
  ImageView right() const { return {pixels.data() + columns, columns, rows, 2 * columns}; }
};

/// Makes pictures of a stream of PGM files with the comment from sim/README.md.
class PictureStream {
 public:
  void feed(std::string_view bytes);
  /// The next complete picture. FileError where the stream is invalid; it is unusable from there
  /// on.
  std::optional<StereoPicture> take();
  void clear() { waiting_.clear(); }

 private:
  std::string waiting_;
};

}  // namespace saphira::vision
