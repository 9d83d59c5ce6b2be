#pragma once

#include <string>

#include "saphira/authority/latches.hpp"

namespace saphira::bridge {

/// The file that keeps an emergency stop, and whether autonomy waits for a person, over a restart
/// of the bridge. There is one only while something is latched.
class LatchFile {
 public:
  /// An empty path: nothing is kept.
  explicit LatchFile(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  /// The latched stop. A file that is there and cannot be read means an emergency stop.
  authority::Latches read() const;
  /// Why it could not be kept, in words; empty where it was.
  std::string write(const authority::Latches& latches) const;

 private:
  std::string path_;
};

}  // namespace saphira::bridge
