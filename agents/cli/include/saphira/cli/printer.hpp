#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string_view>

namespace saphira::cli {

/// Prints without ever waiting for whoever reads: a frozen terminal, Ctrl-S or a full pipe hold up
/// a thread of its own, and nobody else. For programs that hold something while they print: a robot
/// that is driven, a goal, children that are supervised.
class Printer {
 public:
  /// `room` [bytes] waits at most to be printed; what is beyond is left out, and counted.
  explicit Printer(int fd, std::size_t room = 1U << 18U);
  /// Leaves what could not be printed.
  ~Printer();
  Printer(const Printer&) = delete;
  Printer& operator=(const Printer&) = delete;

  /// Whole lines, in their order.
  void print(std::string_view text);
  /// A picture over the last one: of those that wait, only the newest is printed.
  void show(std::string_view picture);
  /// Waits until everything is printed; false when the time is up before.
  bool flush(std::chrono::milliseconds limit);
  /// True where nobody will ever read: the pipe or the terminal is closed.
  bool closed() const;

 private:
  struct Shared;
  static void run(const std::shared_ptr<Shared>& shared);

  std::shared_ptr<Shared> shared_;  ///< outlives a printer whose thread is held up
};

/// Of this program's standard output and standard error.
Printer& out();
Printer& err();
/// As std::printf, through out(); with complain, through err().
[[gnu::format(printf, 1, 2)]] void print(const char* format, ...);
[[gnu::format(printf, 1, 2)]] void complain(const char* format, ...);
/// At the end of a program: waits for a moment that what was said is read.
void flush_output();

}  // namespace saphira::cli
