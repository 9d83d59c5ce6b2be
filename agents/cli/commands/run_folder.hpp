#pragma once

#include <string>
#include <vector>

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

/// That a robot has each of its programs once on this machine, by whatever deployments.
class ProgramLocks {
 public:
  ProgramLocks() = default;
  ~ProgramLocks();
  ProgramLocks(const ProgramLocks&) = delete;
  ProgramLocks& operator=(const ProgramLocks&) = delete;

  /// holder: which deployment this is, for who comes second. std::runtime_error that names the
  /// holder when the program of that robot and domain is held.
  void hold(const std::string& program, const std::string& robot, unsigned domain,
            const std::string& holder);

 private:
  std::vector<int> locks_;
};

}  // namespace saphira::cli
