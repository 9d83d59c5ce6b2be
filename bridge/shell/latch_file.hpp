#pragma once

#include <string>

#include "saphira/authority/latches.hpp"

namespace saphira::bridge {

/// The file that keeps an emergency stop, and autonomy's wait for a person, over a restart of the
/// bridge. It exists only while a latch is set.
class LatchFile {
 public:
  /// An empty path: nothing is saved.
  explicit LatchFile(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  /// The saved latches. An unreadable file counts as an emergency stop.
  authority::Latches read() const;
  /// The reason why it could not be saved, in words; empty where it was.
  std::string write(const authority::Latches& latches) const;

 private:
  std::string path_;
};

}  // namespace saphira::bridge
