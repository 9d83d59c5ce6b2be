#pragma once

#include <string>

namespace saphira::cli {

/// A folder of ours for what runs: sockets, and what must outlast a restart.
class RunFolder {
 public:
  /// A temporary one, which goes with the object.
  RunFolder();
  /// The one of that name, /tmp/saphira-<uid>/<name>, which stays. std::runtime_error when another
  /// process holds it.
  explicit RunFolder(const std::string& name);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
  int lock_ = -1;
};

}  // namespace saphira::cli
