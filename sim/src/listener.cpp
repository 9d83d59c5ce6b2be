#include "listener.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "saphira/base/full_disk.hpp"
#include "saphira/base/text.hpp"

namespace saphira::sim {

namespace {

sockaddr_un local_address(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path)
    throw UnusableFile("socket " + path + ": expected a path of 1 to " +
                       std::to_string(sizeof address.sun_path - 1) + " characters");
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

}  // namespace

void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

void expect_socket(const std::string& path) {
  local_address(path);
  struct stat there {};
  if (::lstat(path.c_str(), &there) == 0 && !S_ISSOCK(there.st_mode))
    throw UnusableFile("socket " + path + ": expected a new name, or a socket; found " +
                       (S_ISDIR(there.st_mode)   ? "a folder"
                        : S_ISLNK(there.st_mode) ? "a link"
                        : S_ISREG(there.st_mode) ? "a file"
                                                 : "a device or a pipe") +
                       ", which stays as it is");
}

Listener::~Listener() {
  // Unless another simulator has replaced it meanwhile.
  struct stat now {};
  if (fd_ && !path_.empty() && ::stat(path_.c_str(), &now) == 0 && now.st_ino == inode_)
    ::unlink(path_.c_str());
}

Descriptor Listener::accept() const {
  return Descriptor(::accept4(fd_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
}

Listener Listener::local(const std::string& path) {
  Listener out;
  expect_socket(path);
  const sockaddr_un address = local_address(path);
  out.name_ = path;
  // A killed simulator leaves its socket behind; a living one answers.
  const Descriptor probe(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const auto* where = reinterpret_cast<const sockaddr*>(&address);
  struct stat there {};
  if (::lstat(path.c_str(), &there) == 0) {
    if (::connect(probe, where, sizeof address) == 0)
      throw UnusableFile("socket " + path + ": another simulator listens on it");
    if (errno == ECONNREFUSED)
      ::unlink(path.c_str());
  }
  out.fd_.reset(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!out.fd_ || ::bind(out.fd_, where, sizeof address) != 0 || ::listen(out.fd_, 8) != 0)
    fail_to_be("socket " + path, "made");
  out.path_ = path;
  if (::stat(path.c_str(), &there) == 0)
    out.inode_ = there.st_ino;
  return out;
}

Listener Listener::tcp(const std::string& text, std::uint16_t port) {
  Listener out;
  out.name_ = text + ":" + std::to_string(port);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  if (::inet_pton(AF_INET, text.c_str(), &address.sin_addr) != 1)
    throw std::invalid_argument("address " + text + ": expected four numbers, such as 127.0.0.1");
  out.fd_.reset(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int yes = 1;
  if (out.fd_)
    ::setsockopt(out.fd_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (!out.fd_ || ::bind(out.fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(out.fd_, 8) != 0)
    fail("port " + out.name_);
  socklen_t size = sizeof address;
  if (::getsockname(out.fd_, reinterpret_cast<sockaddr*>(&address), &size) == 0)
    out.name_ = text + ":" + std::to_string(ntohs(address.sin_port));
  return out;
}

Terminal::Terminal(std::string link) : link_(std::move(link)) {
  master_.reset(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK));
  std::array<char, 64> device{};
  if (!master_ || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0 ||
      ::ptsname_r(master_, device.data(), device.size()) != 0)
    fail("pseudo-terminal");
  device_ = device.data();
  // A new terminal would echo until its client has configured it.
  termios settings{};
  ::tcgetattr(master_, &settings);
  ::cfmakeraw(&settings);
  ::tcsetattr(master_, TCSANOW, &settings);
  // A terminal reports its unused state only after a first use.
  const Descriptor once(::open(device_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  // A killed simulator leaves its link behind.
  struct stat there {};
  if (::lstat(link_.c_str(), &there) == 0) {
    if (!S_ISLNK(there.st_mode))
      throw UnusableFile("terminal " + link_ +
                         ": there is a file already that is no symbolic link");
    ::unlink(link_.c_str());
  }
  if (::symlink(device_.c_str(), link_.c_str()) != 0)
    fail_to_be("terminal " + link_, "made");
}

Terminal::~Terminal() {
  // Unless another simulator has replaced it meanwhile.
  std::array<char, 64> target{};
  const ssize_t size = ::readlink(link_.c_str(), target.data(), target.size() - 1);
  if (size > 0 && device_ == target.data())
    ::unlink(link_.c_str());
}

bool Terminal::is_open() const {
  pollfd look{master_, 0, 0};
  return ::poll(&look, 1, 0) >= 0 && (look.revents & POLLHUP) == 0;
}

void Terminal::forget() const {
  ::tcflush(master_, TCOFLUSH);
}

}  // namespace saphira::sim
