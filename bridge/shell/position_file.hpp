#pragma once

#include <optional>
#include <string>

#include "saphira/base/descriptor.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/reflector/odometry.hpp"

namespace saphira::bridge {

/// The file that keeps the odom frame over a restart of the bridge (--state).
class PositionFile {
 public:
  /// An empty path: nothing is saved. std::invalid_argument where it is another file, or cannot be
  /// opened for another reason than a full disk.
  explicit PositionFile(std::string path, Files files = Files::kChange);

  /// Its content; nothing where the file is new, or nothing is saved.
  const std::optional<reflector::OdometryMemory>& found() const { return found_; }
  /// Its damage, and the consequence; empty: none.
  const std::string& trouble() const { return trouble_; }
  /// The reason why it could not be saved, in words; empty where it was, and where that was said.
  std::string write(const reflector::OdometryMemory& memory);

 private:
  bool open();

  std::string path_;
  bool changes_;
  std::optional<reflector::OdometryMemory> found_;
  std::string trouble_;
  std::string told_;
  Descriptor fd_;
};

}  // namespace saphira::bridge
