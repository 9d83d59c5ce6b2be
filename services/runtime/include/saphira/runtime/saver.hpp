#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <string>

namespace saphira::runtime {

/// Saves a program's state to a file, at most once a second. A disk may take longer than a cycle,
/// so the file is written in the background, whole or not at all.
class Saver {
 public:
  /// An empty path: nothing is saved.
  explicit Saver(std::string path) : path_(std::move(path)) {}

  /// Begins to write the result of `text`, where due. Returns a message for the log, once, where it
  /// cannot be written; otherwise empty.
  std::string offer(const std::function<std::string()>& text);
  /// Why the newest state is not saved; empty: it is, as far as is known.
  const std::string& trouble() const { return trouble_; }

 private:
  using Clock = std::chrono::steady_clock;

  std::string path_;
  Clock::time_point began_ = Clock::now();
  std::future<std::string> writing_;  ///< its trouble, in words
  std::string trouble_;
};

}  // namespace saphira::runtime
