#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace saphira {

/// The files of one kind in a folder, and those changed since the last look. For files that people
/// change while programs use them.
class WatchedFolder {
 public:
  /// extension: with its dot, such as ".act".
  WatchedFolder(std::string path, std::string extension);

  struct Changes {
    std::vector<std::string> changed;  ///< names in the folder, sorted: came or were written
    std::vector<std::string> gone;
    bool missing = false;  ///< the folder cannot be read; the other members are unset
    bool any() const { return !changed.empty() || !gone.empty(); }
  };
  /// A few microseconds a file.
  Changes poll();

  const std::string& path() const { return path_; }
  std::string path_of(const std::string& name) const;

 private:
  struct Stamp {
    std::int64_t time = 0;     ///< [ns] of its content
    std::int64_t changed = 0;  ///< [ns] of any change: a copy from a backup keeps the first
    std::uint64_t file = 0;    ///< identity of the file under this name
    std::uint64_t size = 0;

    bool operator==(const Stamp&) const = default;
  };
  std::string path_;
  std::string extension_;
  std::map<std::string, Stamp> known_;
};

}  // namespace saphira
