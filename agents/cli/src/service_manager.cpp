#include "saphira/cli/service_manager.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace saphira::cli {

namespace {

std::string take_variable(const char* name) {
  const char* const value = std::getenv(name);
  std::string taken = value == nullptr ? "" : value;
  unsetenv(name);
  return taken;
}

}  // namespace

ServiceManager::ServiceManager()
    : socket_(take_variable("NOTIFY_SOCKET")), microseconds_(take_variable("WATCHDOG_USEC")) {
  const std::string process = take_variable("WATCHDOG_PID");
  const long long period = std::strtoll(microseconds_.c_str(), nullptr, 10);
  const bool ours = process.empty() || process == std::to_string(getpid());
  if (!socket_.empty() && ours && period > 0)
    period_ = std::chrono::milliseconds(std::max(1LL, period / 2000));
}

void ServiceManager::restore() const {
  if (!socket_.empty())
    setenv("NOTIFY_SOCKET", socket_.c_str(), 1);
  if (period_)
    setenv("WATCHDOG_USEC", microseconds_.c_str(), 1);
}

void ServiceManager::ready(const std::string& status) const {
  send("READY=1\nSTATUS=" + status + "\n");
}

void ServiceManager::stopping() const {
  send("STOPPING=1\n");
}

void ServiceManager::alive() const {
  if (period_)
    send("WATCHDOG=1\n");
}

void ServiceManager::send(const std::string& lines) const {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (socket_.empty() || socket_.size() >= sizeof address.sun_path)
    return;
  std::memcpy(address.sun_path, socket_.data(), socket_.size());
  if (socket_.front() == '@')
    address.sun_path[0] = '\0';  // an abstract name
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0)
    return;
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_.size());
  sendto(fd, lines.data(), lines.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
         reinterpret_cast<const sockaddr*>(&address), size);
  close(fd);
}

}  // namespace saphira::cli
