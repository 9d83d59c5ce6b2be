#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace saphira::cli {

/// Prints without waiting for the reader: a frozen terminal, Ctrl-S or a full pipe stop a separate
/// thread only. For programs that hold something while they print: a driven robot, a goal,
/// supervised children.
class Printer {
 public:
  /// At most `room` [bytes] are queued; further text is dropped, and counted.
  explicit Printer(int fd, std::size_t room = 1U << 18U);
  /// Drops the unprinted text.
  ~Printer();
  Printer& operator=(Printer&&) = delete;

  /// Prints whole lines, in order.
  void print(std::string_view text);
  /// A picture over the last one: only the newest queued one is printed.
  void show(std::string_view picture);
  /// Lines that a full disk does not take are counted and left out, as a long run needs it.
  void outlast_full_disk();
  /// Waits until everything is printed; false at the time limit.
  bool flush(std::chrono::milliseconds limit);
  /// True where nothing can be printed any more: the pipe or the terminal is closed, or the disk
  /// is full.
  bool closed() const;
  /// The reason in words, if it is another than a reader that has left; otherwise empty.
  std::string trouble() const;

 private:
  struct Shared;
  static void run(const std::shared_ptr<Shared>& shared);

  std::shared_ptr<Shared> shared_;  ///< outlives a printer whose thread is blocked
};

/// Of this program's standard output and standard error.
Printer& out();
Printer& err();
/// As std::printf, through out(); with complain, through err().
[[gnu::format(printf, 1, 2)]] void print(const char* format, ...);
[[gnu::format(printf, 1, 2)]] void complain(const char* format, ...);
/// At the end of a program: waits a moment for the reader.
void flush_output();

}  // namespace saphira::cli
