#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <utility>

namespace saphira::sim {

/// std::runtime_error with the message of errno.
[[noreturn]] void fail(const std::string& what);

/// A file descriptor that is closed with its object.
class Fd {
 public:
  explicit Fd(int fd = -1) : fd_(fd) {}
  ~Fd() { reset(); }
  Fd(Fd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Fd& operator=(Fd&& other) noexcept {
    if (this != &other)
      reset(std::exchange(other.fd_, -1));
    return *this;
  }
  Fd(const Fd&) = delete;
  Fd& operator=(const Fd&) = delete;
  void reset(int fd = -1);
  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_;
};

/// UnusableFile where another file has the path of a local socket, or no socket can have it.
void expect_socket(const std::string& path);

/// A listening socket; a local one is removed at the end. std::runtime_error where it cannot be
/// opened.
class Listener {
 public:
  static Listener local(const std::string& path);
  static Listener tcp(const std::string& address, std::uint16_t port);
  ~Listener();
  Listener(Listener&&) = default;
  Listener& operator=(Listener&&) = delete;
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  int fd() const { return fd_.get(); }
  const std::string& name() const { return name_; }
  /// A client that has connected, not blocking; none for an invalid descriptor.
  Fd accept() const;

 private:
  Listener() = default;

  Fd fd_;
  std::string name_;
  std::string path_;
  ino_t inode_ = 0;
};

/// A pseudo-terminal, in place of a serial line. A symbolic link leads to it, and is removed at the
/// end. As on a real line the client's end is not reported, and unread output is lost.
/// std::runtime_error where it cannot be opened.
class Terminal {
 public:
  explicit Terminal(std::string link);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  int fd() const { return master_.get(); }
  /// The link, and its device.
  std::string name() const { return link_ + " (" + device_ + ")"; }
  /// True where a client has it open.
  bool is_open() const;
  /// Discards unread output.
  void forget() const;

 private:
  std::string link_;
  std::string device_;
  Fd master_;
};

}  // namespace saphira::sim
