#include "position_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace saphira::bridge {
namespace {

constexpr std::size_t kSize = 256;

}  // namespace

PositionFile::PositionFile(std::string path) : path_(std::move(path)) {
  if (path_.empty())
    return;
  fd_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (fd_ < 0)
    throw std::invalid_argument("--state " + path_ + ": " + std::strerror(errno));
}

PositionFile::~PositionFile() {
  close();
}

void PositionFile::close() {
  if (fd_ >= 0)
    ::close(std::exchange(fd_, -1));
}

std::string PositionFile::read() const {
  if (fd_ < 0)
    return {};
  std::array<char, 2 * kSize> buffer{};
  const ssize_t n = ::pread(fd_, buffer.data(), buffer.size(), 0);
  return {buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(n, 0))};
}

std::string PositionFile::write(const reflector::OdometryMemory& memory) {
  if (fd_ < 0)
    return {};
  // One write of one size: a kill leaves the old line or the new one.
  std::string text = reflector::to_text(memory);
  text.resize(kSize, ' ');
  text.back() = '\n';
  const ssize_t written = ::pwrite(fd_, text.data(), text.size(), 0);
  if (written == static_cast<ssize_t>(text.size()))
    return {};
  std::string why =
      path_ + ": " + (written < 0 ? std::strerror(errno) : "only a part of it was written");
  close();
  return why;
}

}  // namespace saphira::bridge
