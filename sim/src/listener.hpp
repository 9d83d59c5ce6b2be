#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <utility>

namespace saphira::sim {

/// std::runtime_error with what errno says.
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

/// A socket that is listened on; a local one is removed at the end. std::runtime_error where it
/// cannot be had.
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
  /// A client that has connected, not blocking; none where the descriptor is none.
  Fd accept() const;

 private:
  Listener() = default;

  Fd fd_;
  std::string name_;
  std::string path_;
  ino_t inode_ = 0;
};

/// A pseudo-terminal: what a client opens in place of a serial line. A symbolic link leads to it,
/// and is removed at the end. As on a real line nobody is told that the client has gone, and what
/// nobody reads is lost. std::runtime_error where it cannot be had.
class Terminal {
 public:
  explicit Terminal(std::string link);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  int fd() const { return master_.get(); }
  /// The link, and the device that it leads to.
  std::string name() const { return link_ + " (" + device_ + ")"; }
  /// True where a client has it open.
  bool is_open() const;
  /// Forgets what has been written to it and not been read.
  void forget() const;

 private:
  std::string link_;
  std::string device_;
  Fd master_;
};

}  // namespace saphira::sim
