#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <string>

namespace saphira::runtime {

/// Keeps a file of what outlives a program, at most once a second: a disk may take longer than a
/// cycle, so it is written in the background, and whole or not at all.
class Saver {
 public:
  /// An empty path: nothing is kept.
  explicit Saver(std::string path) : path_(std::move(path)) {}

  /// Begins to write what `text` gives, where it is time to. What there is to tell the log: that it
  /// cannot be written, once; otherwise empty.
  std::string offer(const std::function<std::string()>& text);

 private:
  using Clock = std::chrono::steady_clock;

  std::string path_;
  Clock::time_point began_ = Clock::now();
  std::future<bool> writing_;
  bool works_ = true;
};

}  // namespace saphira::runtime
