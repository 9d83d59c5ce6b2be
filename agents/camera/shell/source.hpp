#pragma once

#include <memory>
#include <optional>
#include <string>

#include "saphira/camera/frame.hpp"

namespace saphira::camera {

/// An opened camera. It is closed with its object.
class Source {
 public:
  virtual ~Source() = default;
  Source& operator=(Source&&) = delete;

  /// Readable where frames are there.
  virtual int fd() const = 0;
  /// The newest frame; none: not yet. std::runtime_error: the camera is gone.
  virtual std::optional<Frame> read() = 0;
};

/// The simulator's pictures (saphira-sim --camera-socket). std::runtime_error with the reason.
std::unique_ptr<Source> open_socket(const std::string& path);
/// A camera of Linux (V4L2), in a size as near as it has. std::runtime_error with the reason.
std::unique_ptr<Source> open_device(const std::string& path, int columns, int rows);

}  // namespace saphira::camera
