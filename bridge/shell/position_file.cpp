#include "position_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "saphira/base/archive.hpp"
#include "saphira/base/full_disk.hpp"

namespace saphira::bridge {
namespace {

constexpr std::size_t kSize = 500;  // without its sum

}  // namespace

PositionFile::PositionFile(std::string path, Files files)
    : path_(std::move(path)), changes_(!path_.empty() && files == Files::kChange) {
  if (path_.empty())
    return;
  trouble_ = read_or_set_aside(
      path_,
      [this](const std::string& content) {
        found_ = restored<reflector::OdometryMemory>(unsealed(content, path_));
      },
      files);
  if (changes_ && !open() && !is_full(errno))
    throw std::invalid_argument("--state " + path_ + ": " + std::strerror(errno));
}

bool PositionFile::open() {
  if (fd_ < 0)
    fd_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  return fd_ >= 0;
}

std::string PositionFile::write(const reflector::OdometryMemory& memory) {
  if (!changes_)
    return {};
  // One write of one size: a kill leaves the old line or the new one.
  std::string text = saved(memory);
  text.resize(kSize, ' ');
  text = sealed(text);
  const ssize_t written = open() ? ::pwrite(fd_, text.data(), text.size(), 0) : -1;
  const std::string why =
      written == static_cast<ssize_t>(text.size())
          ? ""
          : path_ + ": " + (written < 0 ? std::strerror(errno) : "only a part of it was written");
  return why == std::exchange(told_, why) ? "" : why;
}

}  // namespace saphira::bridge
