#pragma once

#include <optional>
#include <string>

#include "saphira/authority/latches.hpp"

namespace saphira::bridge {

/// The file that keeps an emergency stop, and autonomy's wait for a person, over a restart of the
/// bridge. It exists only while a latch is set. FILE.room beside it keeps room for it, so that an
/// emergency stop is kept on a disk that is full by then.
class LatchFile {
 public:
  /// An empty path: nothing is saved.
  explicit LatchFile(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  /// The saved latches. An unreadable file counts as an emergency stop.
  authority::Latches read() const;
  /// The reason why it could not be saved, in words; empty where it was. Then tend() tries again.
  std::string write(const authority::Latches& latches);
  /// Keeps what was not kept, and the room. Now and then.
  void tend();

 private:
  bool keep(const std::string& text) const;
  /// In the place of a file that is there, under the name of this one.
  bool fill(const std::string& file, const std::string& text) const;

  std::string path_;
  std::optional<std::string> unkept_;
};

}  // namespace saphira::bridge
