#include "vision/shell/pictures.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "saphira/base/local_socket.hpp"
#include "saphira/base/text.hpp"

namespace saphira::vision {
namespace {

constexpr std::size_t kKept = 4;
constexpr int kRetry = 500;  // [ms]

}  // namespace

Pictures::Pictures(std::string path, std::function<void()> came)
    : path_(std::move(path)),
      came_(std::move(came)),
      stop_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (path_.empty()) {
    trouble_ = "no stereo socket was given";
    return;
  }
  trouble_ = path_ + ": not connected yet";
  thread_ = std::thread([this] { run(); });
}

Pictures::~Pictures() {
  const std::uint64_t one = 1;
  (void)!::write(stop_, &one, sizeof one);
  if (thread_.joinable())
    thread_.join();
  ::close(stop_);
}

bool Pictures::has(std::uint64_t cycle) const {
  const std::lock_guard lock(mutex_);
  return !pictures_.empty() && pictures_.back().cycle >= cycle;
}

std::optional<StereoPicture> Pictures::take(std::uint64_t cycle) {
  const std::lock_guard lock(mutex_);
  std::optional<StereoPicture> newest;
  while (!pictures_.empty() && pictures_.front().cycle <= cycle) {
    newest = std::move(pictures_.front());
    pictures_.pop_front();
  }
  return newest;
}

bool Pictures::connected() const {
  const std::lock_guard lock(mutex_);
  return connected_;
}

std::string Pictures::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

void Pictures::say(bool connected, std::string trouble) {
  const std::lock_guard lock(mutex_);
  connected_ = connected;
  trouble_ = std::move(trouble);
  if (!connected)
    pictures_.clear();
}

bool Pictures::pause(int milliseconds) const {
  pollfd stop{stop_, POLLIN, 0};
  return ::poll(&stop, 1, milliseconds) > 0;
}

void Pictures::run() {
  do {
    const Descriptor fd = connect_local(path_);
    if (fd < 0) {
      say(false, path_ + ": " + std::strerror(errno));
      continue;
    }
    say(true, "");
    read(fd);
  } while (!pause(kRetry));
}

void Pictures::read(int fd) {
  PictureStream stream;
  std::array<char, 65536> buffer;
  while (true) {
    std::array<pollfd, 2> fds{{{fd, POLLIN, 0}, {stop_, POLLIN, 0}}};
    if (::poll(fds.data(), fds.size(), -1) < 0 && errno != EINTR)
      return say(false, path_ + ": " + std::strerror(errno));
    if (fds[1].revents != 0)
      return;
    const ssize_t size = ::recv(fd, buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (size < 0 && (errno == EAGAIN || errno == EINTR))
      continue;
    if (size <= 0)
      return say(false, path_ + ": closed by the other side");
    try {
      stream.feed({buffer.data(), static_cast<std::size_t>(size)});
      while (auto picture = stream.take()) {
        {
          const std::lock_guard lock(mutex_);
          // A new connection of the robot counts anew: older pictures belong to the last one.
          if (!pictures_.empty() && pictures_.back().cycle >= picture->cycle)
            pictures_.clear();
          pictures_.push_back(std::move(*picture));
          if (pictures_.size() > kKept)
            pictures_.pop_front();
        }
        if (came_)
          came_();
      }
    } catch (const FileError& error) {
      return say(false, path_ + ": " + error.what());
    }
  }
}

}  // namespace saphira::vision
