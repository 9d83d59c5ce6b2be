#include "serial_line.hpp"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <vector>

namespace saphira::test {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kTick{1};
constexpr milliseconds kRetry{50};  // to find the robot
constexpr milliseconds kRest{20};   // after which no more bytes of a packet come

int connect_to(const std::string& path) {
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  path.copy(name.sun_path, sizeof name.sun_path - 1);
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0)
    return fd;
  ::close(fd);
  return -1;
}

}  // namespace

SerialLine::SerialLine(std::string device, std::string robot_socket, int baud)
    : device_(std::move(device)),
      socket_(std::move(robot_socket)),
      byte_(baud > 0 ? 10'000'000'000LL / baud : 0) {
  open_device();
  thread_ = std::thread([this] { run(); });
}

SerialLine::~SerialLine() {
  stop_ = true;
  thread_.join();
  close_device();
  ::close(robot_);
}

void SerialLine::open_device() {
  master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
  std::array<char, 64> name{};
  if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0 ||
      ::ptsname_r(master_, name.data(), name.size()) != 0)
    throw std::runtime_error("no pseudo-terminal");
  // A new terminal would echo its input until the program that opens it has set it up.
  termios settings{};
  ::tcgetattr(master_, &settings);
  ::cfmakeraw(&settings);
  ::tcsetattr(master_, TCSANOW, &settings);
  ::unlink(device_.c_str());
  if (::symlink(name.data(), device_.c_str()) != 0)
    throw std::runtime_error(device_ + ": cannot be made");
}

void SerialLine::close_device() {
  ::unlink(device_.c_str());
  ::close(master_);
  master_ = -1;
}

bool SerialLine::has_robot() {
  const std::scoped_lock lock(mutex_);
  return robot_ >= 0;
}

/// False after the end of the other side.
bool SerialLine::take(int fd, int direction) {
  Direction& d = directions_[direction];
  std::array<std::uint8_t, 512> buffer{};
  const ssize_t n = ::read(fd, buffer.data(), buffer.size());
  if (n <= 0)
    return n < 0 && (errno == EAGAIN || errno == EINTR);
  if (cut_)
    return true;
  if (d.waiting.empty())
    d.due = Clock::now() + byte_;
  d.waiting.insert(d.waiting.end(), buffer.begin(), buffer.begin() + n);
  return true;
}

bool SerialLine::give(int fd, int direction) {
  Direction& d = directions_[direction];
  const auto now = Clock::now();
  std::vector<std::uint8_t> out;
  while (!d.waiting.empty() && d.due <= now) {
    out.push_back(d.waiting.front());
    d.waiting.pop_front();
    d.due += byte_;
  }
  if (out.empty() || fd < 0 || cut_)
    return true;
  bytes_[direction] += out.size();
  // Bytes that the other end does not take are lost, as in an unread receiver.
  const ssize_t n = direction == 0 ? ::send(fd, out.data(), out.size(), MSG_NOSIGNAL)
                                   : ::write(fd, out.data(), out.size());
  return n >= 0 || errno == EAGAIN || errno == EINTR;
}

void SerialLine::run() {
  auto next_try = Clock::now();
  auto came = Clock::now();  // the newest bytes to the robot
  // The bytes to the robot still go through at the end: otherwise it would have half a packet.
  for (bool done = false; !done;) {
    const bool stop = stop_;
    bool busy = false;
    std::array<pollfd, 2> fds{{{-1, POLLIN, 0}, {-1, POLLIN, 0}}};
    {
      const std::scoped_lock lock(mutex_);
      if (robot_ < 0 && Clock::now() >= next_try) {
        robot_ = connect_to(socket_);
        next_try = Clock::now() + kRetry;
      }
      fds[0].fd = master_;
      fds[1].fd = robot_;
      busy = !directions_[0].waiting.empty() || !directions_[1].waiting.empty();
    }
    ::poll(fds.data(), fds.size(), static_cast<int>((busy ? kTick : kRetry / 2).count()));
    const std::scoped_lock lock(mutex_);
    listened_ = fds[0].fd >= 0 && (fds[0].revents & POLLHUP) == 0;
    if (!listened_)
      std::this_thread::sleep_for(kTick);  // poll does not wait on a closed descriptor
    const bool comes = (fds[0].revents & POLLIN) != 0 && fds[0].fd == master_;
    if (comes) {
      take(master_, 0);
      came = Clock::now();
    }
    bool robot_is_there = true;
    if (fds[1].revents != 0 && robot_ >= 0)
      robot_is_there = take(robot_, 1);
    robot_is_there = give(robot_, 0) && robot_is_there;
    // A terminal that is not open would echo written bytes.
    give(listened_ ? master_ : -1, 1);
    if (!robot_is_there && robot_ >= 0) {
      ::close(robot_);
      robot_ = -1;
    }
    done = stop && Clock::now() - came > kRest && directions_[0].waiting.empty();
  }
}

}  // namespace saphira::test
