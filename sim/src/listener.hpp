#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

#include "saphira/base/descriptor.hpp"

namespace saphira::sim {

/// std::runtime_error with the message of errno.
[[noreturn]] void fail(const std::string& what);

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

  int fd() const { return fd_; }
  const std::string& name() const { return name_; }
  /// A client that has connected, not blocking; none for an invalid descriptor.
  Descriptor accept() const;

 private:
  Listener() = default;

  Descriptor fd_;
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
  Terminal& operator=(Terminal&&) = delete;

  int fd() const { return master_; }
  /// The link, and its device.
  std::string name() const { return link_ + " (" + device_ + ")"; }
  /// True where a client has it open.
  bool is_open() const;
  /// Discards unread output.
  void forget() const;

 private:
  std::string link_;
  std::string device_;
  Descriptor master_;
};

}  // namespace saphira::sim
