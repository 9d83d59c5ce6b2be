#include "source.hpp"

#include <fcntl.h>
#include <libv4l2.h>
#include <linux/videodev2.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>

#include "saphira/base/local_socket.hpp"
#include "saphira/base/text.hpp"

namespace saphira::camera {

namespace {

bool is_later() {
  return errno == EAGAIN || errno == EINTR;
}

class SocketSource final : public Source {
 public:
  explicit SocketSource(const std::string& path) : path_(path), fd_(connect_local(path)) {
    if (fd_ < 0)
      throw std::runtime_error(cannot_be(path, "reached") + " (does the simulator run?)");
  }

  int fd() const override { return fd_; }
  std::optional<Frame> read() override {
    std::array<char, 65536> part;
    ssize_t size = 0;
    while ((size = ::recv(fd_, part.data(), part.size(), MSG_DONTWAIT)) > 0)
      stream_.feed({part.data(), static_cast<std::size_t>(size)});
    if (size == 0 || !is_later())
      throw std::runtime_error(path_ + ": closed by the other side");
    return stream_.take();
  }

 private:
  std::string path_;
  Descriptor fd_;
  PpmStream stream_;
};

/// An opened device, which is also closed where the camera does not start.
struct Device {
  explicit Device(const std::string& path)
      : fd(v4l2_open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)) {}
  ~Device() {
    if (fd >= 0)
      v4l2_close(fd);
  }
  Device& operator=(Device&&) = delete;

  const int fd;
};

/// A camera of V4L2. libv4l2 converts the camera's own format.
class DeviceSource final : public Source {
 public:
  DeviceSource(const std::string& path, int columns, int rows) : path_(path), device_(path) {
    if (device_.fd < 0)
      throw std::runtime_error(cannot_be(path, "opened"));
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    format.fmt.pix.width = static_cast<std::uint32_t>(columns);
    format.fmt.pix.height = static_cast<std::uint32_t>(rows);
    format.fmt.pix.pixelformat = V4L2_PIX_FMT_RGB24;
    format.fmt.pix.field = V4L2_FIELD_ANY;
    if (v4l2_ioctl(device_.fd, VIDIOC_S_FMT, &format) != 0 ||
        format.fmt.pix.pixelformat != V4L2_PIX_FMT_RGB24)
      throw std::runtime_error(path + ": is no camera that gives pictures in colour");
    frame_.columns = static_cast<int>(format.fmt.pix.width);
    frame_.rows = static_cast<int>(format.fmt.pix.height);
    frame_.pixels.resize(3 * static_cast<std::size_t>(frame_.columns) *
                         static_cast<std::size_t>(frame_.rows));
    read();  // the first call starts the camera
  }

  int fd() const override { return device_.fd; }
  std::optional<Frame> read() override {
    const ssize_t size = v4l2_read(device_.fd, frame_.pixels.data(), frame_.pixels.size());
    if (size < 0 && !is_later())
      throw std::runtime_error(cannot_be(path_, "read"));
    if (size != static_cast<ssize_t>(frame_.pixels.size()))
      return std::nullopt;
    return frame_;
  }

 private:
  std::string path_;
  Device device_;
  Frame frame_;
};

}  // namespace

std::unique_ptr<Source> open_socket(const std::string& path) {
  return std::make_unique<SocketSource>(path);
}

std::unique_ptr<Source> open_device(const std::string& path, int columns, int rows) {
  return std::make_unique<DeviceSource>(path, columns, rows);
}

}  // namespace saphira::camera
