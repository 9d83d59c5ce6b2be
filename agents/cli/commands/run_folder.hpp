#pragma once

#include <sys/types.h>

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

/// A deployment that runs on this machine, started by this user.
struct Running {
  std::string name;  ///< of its folder, such as demo-pioneer-0
  pid_t pid = 0;     ///< of its saphira up
};
std::vector<Running> running_deployments();
/// What is said by the deployment of that name while it has no terminal.
std::string log_of(const std::string& name);

/// A demonstration that runs on this machine, with a bus of its own: commands of this user that
/// name no bus are meant for it, as long as the object lives.
class RunningDemo {
 public:
  RunningDemo(const std::string& robot, unsigned domain);
  ~RunningDemo();
  RunningDemo(const RunningDemo&) = delete;
  RunningDemo& operator=(const RunningDemo&) = delete;

 private:
  std::string path_;
  int lock_ = -1;
};

/// The robot and domain of the newest one; robot empty: none runs.
struct DemoBus {
  std::string robot;
  unsigned domain = 0;
};
DemoBus running_demo();

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
