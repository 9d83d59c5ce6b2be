#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "internal.hpp"

namespace saphira::bus::internal {

Wake::Wake() : fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (fd_ < 0)
    throw std::system_error(errno, std::generic_category(), "eventfd");
}

Wake::~Wake() {
  close(fd_);
}

void Wake::signal() {
  // First the flag, then the sleep state; rest() in reverse order: one of both sees the other.
  if (pending_.exchange(true) || !asleep_.load())
    return;
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = write(fd_, &one, sizeof one);
}

void Wake::clear() {
  // First the descriptor, then the flag: a signal in between writes nothing, but its samples are
  // there already when the caller takes. In reverse order its write would be consumed and the flag
  // would stay set, for ever.
  std::uint64_t count = 0;
  [[maybe_unused]] const auto got = read(fd_, &count, sizeof count);
  pending_.store(false);
}

}  // namespace saphira::bus::internal
