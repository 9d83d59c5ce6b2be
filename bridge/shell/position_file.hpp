#pragma once

#include <string>

#include "saphira/reflector/odometry.hpp"

namespace saphira::bridge {

/// The file that keeps the odom frame over a restart of the bridge (--state).
class PositionFile {
 public:
  /// An empty path: nothing is kept. std::invalid_argument where it cannot be opened.
  explicit PositionFile(std::string path);
  ~PositionFile();
  PositionFile(const PositionFile&) = delete;
  PositionFile& operator=(const PositionFile&) = delete;

  const std::string& path() const { return path_; }
  /// What is in it, for reflector::from_text; empty where it is new, or nothing is kept.
  std::string read() const;
  /// Why it could not be kept, in words, and empty where it was. After that it is given up.
  std::string write(const reflector::OdometryMemory& memory);

 private:
  void close();

  std::string path_;
  int fd_ = -1;
};

}  // namespace saphira::bridge
