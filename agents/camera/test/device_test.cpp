// A camera of V4L2 without one: the functions of libv4l2 are those of this file.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <libv4l2.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <stdexcept>

#include "source.hpp"
#include "trouble.hpp"

namespace {

constexpr int kFd = 1000;

/// The answers of the camera, and the calls that it got.
struct Camera {
  int open_error = 0;
  std::uint32_t columns = 4;
  std::uint32_t rows = 2;
  std::uint32_t pixel_format = V4L2_PIX_FMT_RGB24;
  int read_error = EAGAIN;
  std::size_t bytes = 0;  ///< of a picture, where there is no error
  std::string path;
  int flags = 0;
  v4l2_format asked{};
  int opened = 0;  ///< less the closed ones
} video;

}  // namespace

extern "C" {
int v4l2_open(const char* file, int flags, ...) {
  video.path = file;
  video.flags = flags;
  errno = video.open_error;
  if (video.open_error != 0)
    return -1;
  ++video.opened;
  return kFd;
}
int v4l2_close(int /*fd*/) {
  --video.opened;
  return 0;
}
int v4l2_ioctl(int fd, unsigned long request, ...) {  // NOLINT(google-runtime-int)
  va_list arguments;
  va_start(arguments, request);
  auto* const format = va_arg(arguments, v4l2_format*);
  va_end(arguments);
  if (fd != kFd || request != VIDIOC_S_FMT)
    return -1;
  video.asked = *format;
  format->fmt.pix.width = video.columns;
  format->fmt.pix.height = video.rows;
  format->fmt.pix.pixelformat = video.pixel_format;
  return 0;
}
ssize_t v4l2_read(int /*fd*/, void* buffer, std::size_t size) {
  errno = video.read_error;
  if (video.read_error != 0)
    return -1;
  const std::size_t read = std::min(size, video.bytes);
  std::fill_n(static_cast<std::uint8_t*>(buffer), read, std::uint8_t{7});
  return static_cast<ssize_t>(read);
}
}

namespace saphira::camera {
namespace {

class DeviceTest : public testing::Test {
 protected:
  DeviceTest() { video = {}; }
  ~DeviceTest() override { EXPECT_EQ(video.opened, 0) << "left open"; }

  static std::string why_not() {
    return test::trouble_of<std::runtime_error>([] { open_device("/dev/video7", 5, 3); });
  }
};

TEST_F(DeviceTest, APictureHasTheSizeThatTheCameraGives) {
  const auto source = open_device("/dev/video7", 5, 3);
  EXPECT_EQ(source->fd(), kFd);
  EXPECT_EQ(video.path, "/dev/video7");
  EXPECT_EQ(video.flags, O_RDWR | O_NONBLOCK | O_CLOEXEC);
  EXPECT_EQ(video.asked.type, V4L2_BUF_TYPE_VIDEO_CAPTURE);
  EXPECT_EQ(video.asked.fmt.pix.width, 5U);
  EXPECT_EQ(video.asked.fmt.pix.height, 3U);
  EXPECT_EQ(video.asked.fmt.pix.pixelformat, V4L2_PIX_FMT_RGB24);
  EXPECT_FALSE(source->read()) << "no picture yet";
  video.read_error = 0;
  video.bytes = 20;
  EXPECT_FALSE(source->read()) << "a part of one";
  video.bytes = 24;
  const auto frame = source->read();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->columns, 4);
  EXPECT_EQ(frame->rows, 2);
  EXPECT_EQ(frame->pixels, std::vector<std::uint8_t>(24, 7));
  EXPECT_EQ(frame->cycle, 0U) << "of no simulator";
}

TEST_F(DeviceTest, WithoutACameraTheReasonIsSaid) {
  video.open_error = ENOENT;
  EXPECT_EQ(why_not(), "/dev/video7: cannot be opened: No such file or directory");
  video.open_error = 0;
  video.pixel_format = V4L2_PIX_FMT_GREY;
  EXPECT_EQ(why_not(), "/dev/video7: is no camera that gives pictures in colour");
}

TEST_F(DeviceTest, ACameraThatDoesNotStartOrIsUnpluggedIsClosed) {
  video.read_error = EBUSY;
  EXPECT_EQ(why_not(), "/dev/video7: cannot be read: Device or resource busy");
  EXPECT_EQ(video.opened, 0);
  video.read_error = EAGAIN;
  const auto source = open_device("/dev/video7", 5, 3);
  video.read_error = ENODEV;
  EXPECT_EQ(test::trouble_of<std::runtime_error>([&] { source->read(); }),
            "/dev/video7: cannot be read: No such device");
}

}  // namespace
}  // namespace saphira::camera
