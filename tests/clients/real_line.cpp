#include "real_line.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace saphira::test {

int RealLine::local(const std::string& path) {
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  path.copy(name.sun_path, sizeof name.sun_path - 1);
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0)
    throw std::runtime_error(path + ": nobody listens");
  return fd;
}

int RealLine::tcp(int port) {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(static_cast<std::uint16_t>(port));
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0)
    throw std::runtime_error("port " + std::to_string(port) + ": nobody listens");
  const int yes = 1;
  ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  return fd;
}

int RealLine::terminal(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings{};
  if (fd < 0 || ::tcgetattr(fd, &settings) != 0)
    throw std::runtime_error(path + ": no terminal");
  ::cfmakeraw(&settings);
  ::cfsetspeed(&settings, B9600);
  ::tcsetattr(fd, TCSANOW, &settings);
  return fd;
}

RealLine::~RealLine() {
  ::close(fd_);
}

double RealLine::now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

void RealLine::send(const Wire& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t size = ::write(fd_, bytes.data() + done, bytes.size() - done);
    if (size <= 0) {
      closed_ = true;
      return;
    }
    done += static_cast<std::size_t>(size);
  }
}

void RealLine::wait(double seconds) {
  const double until = now() + seconds;
  while (true) {
    const double left = until - now();
    pollfd ready{closed_ ? -1 : fd_, POLLIN, 0};
    ::poll(&ready, 1, std::max(0, static_cast<int>(std::ceil(left * 1000.0))));
    if (ready.revents != 0) {
      std::array<std::uint8_t, 512> buffer{};
      const ssize_t size = ::read(fd_, buffer.data(), buffer.size());
      if (size <= 0)
        closed_ = true;
      else
        collect({buffer.begin(), buffer.begin() + size});
    }
    if (left <= 0.0)
      return;
  }
}

}  // namespace saphira::test
