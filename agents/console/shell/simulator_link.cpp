#include "simulator_link.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <utility>

#include "saphira/base/local_socket.hpp"

namespace saphira::console {
namespace {

constexpr double kRetry = 1.0;             // [s]
constexpr std::size_t kLongest = 8 << 20;  // [bytes] of a line

}  // namespace

void SimulatorLink::disconnect() {
  fd_.reset();
  heard_.clear();
}

void SimulatorLink::connect() {
  fd_ = connect_local(socket_, SOCK_NONBLOCK);
}

bool SimulatorLink::poll(double now) {
  if (fd_ < 0 && now - tried_ >= kRetry) {
    tried_ = now;
    connect();
  }
  const std::uint64_t before = world_.number + scene_.number + troubles_.size();
  std::array<char, 65536> part;
  while (fd_ >= 0) {
    const ssize_t size = ::recv(fd_, part.data(), part.size(), MSG_DONTWAIT);
    if (size < 0 && (errno == EAGAIN || errno == EINTR))
      break;
    if (size <= 0 || heard_.size() > kLongest) {
      disconnect();
      break;
    }
    heard_.append(part.data(), static_cast<std::size_t>(size));
  }
  std::size_t begin = 0;
  for (std::size_t end = heard_.find('\n'); end != std::string::npos;
       end = heard_.find('\n', begin)) {
    take(heard_.substr(begin, end - begin));
    begin = end + 1;
  }
  heard_.erase(0, begin);
  return world_.number + scene_.number + troubles_.size() != before;
}

void SimulatorLink::take(std::string line) {
  if (line.starts_with("{\"type\":\"world\""))
    world_ = {std::move(line), world_.number + 1};
  else if (line.starts_with("{\"type\":\"scene\""))
    scene_ = {std::move(line), scene_.number + 1};
  else
    troubles_.push_back(std::move(line));
}

bool SimulatorLink::say(const std::string& text) {
  const std::string line = text + "\n";
  return fd_ >= 0 && ::send(fd_, line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT) ==
                         static_cast<ssize_t>(line.size());
}

std::vector<std::string> SimulatorLink::take_troubles() {
  return std::exchange(troubles_, {});
}

}  // namespace saphira::console
