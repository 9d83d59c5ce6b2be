#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "saphira/cli/running_bus.hpp"

namespace saphira::cli {

/// A folder for running programs: sockets, and files that must outlast a restart.
class RunFolder {
 public:
  /// A temporary folder, removed with the object.
  RunFolder();
  /// The folder of that name, which stays. std::runtime_error when another process holds it.
  /// robot, domain: of its deployment, for running_deployments.
  RunFolder(const std::string& name, const std::string& robot, unsigned domain);
  ~RunFolder();
  RunFolder& operator=(RunFolder&&) = delete;

  const std::string& path() const { return path_; }
  /// Tells running_deployments of it: where the disk has no room for that, by a file in memory.
  void tell();

 private:
  std::string path_;
  int lock_ = -1;
  std::string text_;       ///< still to be told by the lock
  std::string in_memory_;  ///< the file that tells it meanwhile; empty: none
};

/// A running deployment of this user on this machine.
struct Running {
  std::string name;  ///< name of its folder, such as demo-pioneer-0
  pid_t pid = 0;     ///< of its saphira up
  std::string robot;
  unsigned domain = 0;
};
std::vector<Running> running_deployments();
/// The path of the log file of that deployment, for its output without a terminal.
std::string log_of(const std::string& name);

/// The bus of a deployment whose files are meant.
struct FilesOf {
  std::string robot;   ///< empty: any
  std::string domain;  ///< empty: any
};
/// Such as " of robot bee in domain 3"; empty where any is meant.
std::string words_of(const FilesOf& bus);
/// The audits of this machine's robots, the newest first: of this user, and of the system's
/// service.
std::vector<std::string> audit_files(const FilesOf& bus);
/// Likewise the recordings of the last minute after an event.
std::vector<std::string> box_files(const FilesOf& bus);

/// Lets other commands find this bus, as long as the object lives (running_buses); with a full disk
/// by a file in memory.
class FoundBus {
 public:
  explicit FoundBus(const RunningBus& bus);
  ~FoundBus();
  FoundBus& operator=(FoundBus&&) = delete;

 private:
  void end();

  std::string path_;
  int lock_ = -1;
};

/// Keeps the locks of the objects above over an exec() of a new version of this program. Returns
/// their descriptors, in words.
std::string keep_held();
/// The objects that are made from now on take over what keep_held() has kept.
void take_held(const std::string& descriptors);

/// The buses of this machine, newest first: of this user, and of the system's service.
std::vector<RunningBus> running_buses();

/// Ensures that a robot has each of its programs once on this machine, in all deployments.
class ProgramLocks {
 public:
  ProgramLocks() = default;
  ~ProgramLocks();
  ProgramLocks& operator=(ProgramLocks&&) = delete;

  /// holder: name of this deployment, for a second one. std::runtime_error with the holder when the
  /// program of that robot and domain is held.
  void hold(const std::string& program, const std::string& robot, unsigned domain,
            const std::string& holder);

 private:
  std::vector<int> locks_;
};

}  // namespace saphira::cli
