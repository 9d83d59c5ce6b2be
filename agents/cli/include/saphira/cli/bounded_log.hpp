#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace saphira::cli {

/// The log file of a program that nobody watches: its newest part and one older one are kept.
class BoundedLog {
 public:
  /// descriptors: those that the program writes the file by. most: [bytes] of each part.
  BoundedLog(std::string path, std::vector<int> descriptors, std::int64_t most)
      : path_(std::move(path)), descriptors_(std::move(descriptors)), most_(most) {}
  /// Begins a new part where the present one is full: the older one is PATH.old. Call now and then.
  void keep_bounded() const;

 private:
  std::string path_;
  std::vector<int> descriptors_;
  std::int64_t most_;
};

}  // namespace saphira::cli
