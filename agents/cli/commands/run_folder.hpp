#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "saphira/cli/running_bus.hpp"

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

/// A deployment that runs on this machine, started by this user.
struct Running {
  std::string name;  ///< of its folder, such as demo-pioneer-0
  pid_t pid = 0;     ///< of its saphira up
};
std::vector<Running> running_deployments();
/// The path of the log file of that deployment, for its output without a terminal.
std::string log_of(const std::string& name);

/// Lets commands that name no bus find this one, as long as the object lives (running_buses).
class FoundBus {
 public:
  explicit FoundBus(const RunningBus& bus);
  ~FoundBus();
  FoundBus(const FoundBus&) = delete;
  FoundBus& operator=(const FoundBus&) = delete;

 private:
  std::string path_;
  int lock_ = -1;
};

/// The buses of this machine, newest first: of this user, and of the system's service.
std::vector<RunningBus> running_buses();

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
