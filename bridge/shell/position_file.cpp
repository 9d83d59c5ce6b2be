#include "position_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace saphira::bridge {
namespace {

constexpr std::size_t kSize = 256;

}  // namespace

PositionFile::PositionFile(std::string path, Files files) : path_(std::move(path)) {
  if (path_.empty())
    return;
  trouble_ = read_or_set_aside(
      path_,
      [this](const std::string& content) {
        const std::string_view padded = std::string_view(content).substr(0, content.find('\n'));
        const auto line = unsealed_line(padded.substr(0, padded.find_last_not_of(' ') + 1));
        if (line)
          found_ = reflector::from_text(std::string(*line) + "\n");
        if (!found_)
          throw std::runtime_error("it holds no position of the robot");
      },
      files);
  if (files == Files::kStay)
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

std::string PositionFile::write(const reflector::OdometryMemory& memory) {
  if (fd_ < 0)
    return {};
  // One write of one size: a kill leaves the old line or the new one.
  std::string text = reflector::to_text(memory);
  text.pop_back();  // its line break
  text = sealed_line(text);
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
