#include "saphira/camera/frame.hpp"

#include <turbojpeg.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "saphira/base/text.hpp"

namespace saphira::camera {

namespace {

constexpr std::size_t kLongestHeader = 512;
constexpr int kLargest = 4096;   // [pixels] a side
constexpr double kWidest = 3.0;  // [rad]

struct Destroy {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, Destroy>;

void check(const Handle& handle, int status) {
  if (!handle || status != 0)
    throw std::runtime_error(std::string("JPEG: ") + tjGetErrorStr2(handle.get()));
}

}  // namespace

std::optional<Frame> PpmStream::take() {
  std::optional<Frame> newest;
  while (auto frame = next())
    newest = std::move(frame);
  return newest;
}

std::optional<Frame> PpmStream::next() {
  Frame frame;
  unsigned long long cycle = 0;
  int header = 0;
  const std::string begin = waiting_.substr(0, kLongestHeader);
  std::sscanf(begin.c_str(),
              "P6\n# saphira picture cycle=%llu field=%lf height=%lf forward=%lf pan=%lf\n"
              "%d %d\n255%n",
              &cycle, &frame.field_of_view, &frame.height, &frame.pose_in_robot.x,
              &frame.pose_in_robot.th, &frame.columns, &frame.rows, &header);
  if (header == 0 && begin.size() < kLongestHeader &&
      std::string_view("P6\n").starts_with(std::string_view(begin).substr(0, 3)))
    return std::nullopt;  // the header is not whole yet
  const auto within = [](double value, double most) { return std::abs(value) <= most; };
  if (header == 0 || frame.columns < 1 || frame.columns > kLargest || frame.rows < 1 ||
      frame.rows > kLargest || !within(frame.field_of_view, kWidest) || !within(frame.height, 10) ||
      !within(frame.pose_in_robot.x, 10) || !within(frame.pose_in_robot.th, kPi))
    throw FileError("pictures", 1, 1,
                    "expected PPM files (P6) with a comment \"# saphira picture cycle=...\"");
  const std::size_t from = static_cast<std::size_t>(header) + 1;
  const std::size_t size =
      3 * static_cast<std::size_t>(frame.columns) * static_cast<std::size_t>(frame.rows);
  if (waiting_.size() < from + size)
    return std::nullopt;
  frame.cycle = cycle;
  const auto pixels = waiting_.begin() + static_cast<std::ptrdiff_t>(from);
  frame.pixels.assign(pixels, pixels + static_cast<std::ptrdiff_t>(size));
  waiting_.erase(0, from + size);
  return frame;
}

std::vector<std::uint8_t> to_jpeg(const Frame& frame, int quality) {
  const Handle handle(tjInitCompress());
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int status = tjCompress2(handle.get(), frame.pixels.data(), frame.columns, 0, frame.rows,
                                 TJPF_RGB, &bytes, &size, TJSAMP_420, quality, TJFLAG_FASTDCT);
  const std::unique_ptr<unsigned char, decltype(&tjFree)> owner(bytes, tjFree);
  check(handle, status);
  return {bytes, bytes + size};
}

Frame from_jpeg(const std::vector<std::uint8_t>& jpeg) {
  const Handle handle(tjInitDecompress());
  Frame frame;
  int subsampling = 0;
  int colors = 0;
  check(handle, tjDecompressHeader3(handle.get(), jpeg.data(), jpeg.size(), &frame.columns,
                                    &frame.rows, &subsampling, &colors));
  if (frame.columns > kLargest || frame.rows > kLargest)
    throw std::runtime_error("JPEG: larger than 4096 pixels a side");
  frame.pixels.resize(3 * static_cast<std::size_t>(frame.columns) *
                      static_cast<std::size_t>(frame.rows));
  check(handle, tjDecompress2(handle.get(), jpeg.data(), jpeg.size(), frame.pixels.data(),
                              frame.columns, 0, frame.rows, TJPF_RGB, 0));
  return frame;
}

}  // namespace saphira::camera
