#pragma once

#include <unistd.h>

#include <cerrno>
#include <utility>

namespace saphira {

/// A file descriptor that is closed with its object; a negative one is none. Closing keeps errno.
class Descriptor {
 public:
  Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor() { reset(); }
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    if (this != &other)
      reset(std::exchange(other.fd_, -1));
    return *this;
  }
  void reset(int fd = -1) {
    const int why = errno;
    if (fd_ >= 0)
      ::close(fd_);
    errno = why;
    fd_ = fd;
  }
  operator int() const& { return fd_; }
  operator int() const&& = delete;  // it is closed at once
  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_;
};

}  // namespace saphira
