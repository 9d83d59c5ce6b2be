#include "run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>

#include "saphira/base/text.hpp"

namespace saphira::cli {

namespace {

constexpr const char* kServiceFolder = "/var/lib/saphira";  ///< of saphira@.service

/// Advice for a folder that cannot be used.
constexpr const char* kElsewhere =
    "; the variable SAPHIRA_RUN names another folder for what runs (usual: "
    "~/.local/state/saphira/HOST)";
constexpr std::size_t kLongestFolder = 60;  ///< of a socket in it at most 107

/// Makes a private folder; one of another owner is refused.
void make_own(const std::string& path) {
  if (mkdir(path.c_str(), 0700) != 0 && errno != EEXIST)
    throw std::runtime_error(cannot_be(path, "made") + kElsewhere);
  struct stat info {};
  if (lstat(path.c_str(), &info) != 0 || !S_ISDIR(info.st_mode) || info.st_uid != getuid())
    throw std::runtime_error(path + ": expected a folder of this user" + kElsewhere);
}

/// For a user without a home. A cleaner of /tmp may remove it while its programs run.
std::string temporary_folder() {
  return "/tmp/saphira-" + std::to_string(getuid());
}

/// In the user's home, which several machines may share; empty: there is none to write to.
std::string folder_in_home() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  char host[256] = {};
  if (gethostname(host, sizeof host - 1) != 0)
    return {};
  const std::string base = state != nullptr && *state == '/' ? std::string(state)
                           : home != nullptr && *home == '/' ? std::string(home) + "/.local/state"
                                                             : std::string();
  const std::string folder = base + "/saphira/" + host;
  if (base.empty() || folder.size() > kLongestFolder)
    return {};
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  struct stat info {};
  return stat(folder.c_str(), &info) == 0 && info.st_uid == getuid() &&
                 access(folder.c_str(), W_OK) == 0
             ? folder
             : std::string();
}

/// The folder of this user, for all deployments. It has to outlast what runs.
std::string own_folder() {
  const char* const given = std::getenv("SAPHIRA_RUN");
  std::string ours = given != nullptr && *given != '\0' ? std::string(given) : folder_in_home();
  if (ours.empty())
    ours = temporary_folder();
  make_own(ours);
  return ours;
}

/// Opens and locks it; -1 when another process holds the lock. std::runtime_error where it cannot
/// be opened.
int lock(const std::string& path) {
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (file < 0)
    throw std::runtime_error(cannot_be(path, "written") + kElsewhere);
  if (flock(file, LOCK_EX | LOCK_NB) == 0)
    return file;
  close(file);
  return -1;
}

/// The whole content of a locked file.
void fill(int file, const std::string& path, const std::string& text) {
  if (ftruncate(file, 0) != 0 || ::write(file, text.data(), text.size()) < 0)
    throw std::runtime_error(cannot_be(path, "written") + kElsewhere);
}

}  // namespace

RunFolder::RunFolder() {
  path_ = own_folder() + "/temporary-XXXXXX";
  if (mkdtemp(path_.data()) == nullptr)
    throw std::runtime_error(cannot_be(path_, "made") + kElsewhere);
}

RunFolder::RunFolder(const std::string& name, const std::string& robot, unsigned domain) {
  path_ = own_folder() + "/" + name;
  make_own(path_);
  lock_ = lock(path_ + "/lock");
  if (lock_ < 0)
    throw std::runtime_error("this deployment is running already: " + path_ +
                             "/lock is held; saphira stop ends it");
  fill(lock_, path_ + "/lock",
       std::to_string(getpid()) + " " + std::to_string(domain) + " " + robot);
}

RunFolder::~RunFolder() {
  if (lock_ >= 0) {
    close(lock_);
  } else {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
}

std::vector<Running> running_deployments() {
  std::vector<Running> all;
  std::error_code none;
  // One that was started without a home is there, too.
  for (const std::string& folder : std::set<std::string>{own_folder(), temporary_folder()})
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
      const std::string path = entry.path() / "lock";
      if (!std::filesystem::exists(path, none))
        continue;
      // A free lock means that no process runs it.
      const int file = lock(path);
      if (file >= 0) {
        close(file);
        continue;
      }
      Running running{entry.path().filename(), 0, {}, 0};
      std::ifstream in(path);
      in >> running.pid >> running.domain >> std::ws;
      std::getline(in, running.robot);
      if (running.pid > 0)
        all.push_back(running);
    }
  return all;
}

FoundBus::FoundBus(const RunningBus& bus) {
  const std::string folder = own_folder() + "/buses";
  // Readable for others on this machine: a service has another user than the people who command it.
  mkdir(folder.c_str(), 0755);
  path_ =
      folder + "/" + bus.robot + "-" + std::to_string(bus.domain) + "-" + std::to_string(getpid());
  lock_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  const std::string text = to_text(bus);
  if (lock_ < 0 || flock(lock_, LOCK_EX) != 0)
    throw std::runtime_error(cannot_be(path_, "written") + kElsewhere);
  fill(lock_, path_, text);
}

FoundBus::~FoundBus() {
  unlink(path_.c_str());
  close(lock_);
}

std::vector<RunningBus> running_buses() {
  struct Found {
    std::filesystem::file_time_type at;
    RunningBus bus;
  };
  std::vector<Found> found;
  std::error_code none;
  for (const std::string& folder :
       std::set<std::string>{own_folder(), temporary_folder(), kServiceFolder})
    for (const auto& entry : std::filesystem::directory_iterator(folder + "/buses", none)) {
      const std::string path = entry.path();
      const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
      if (file < 0)
        continue;
      std::string text;
      std::getline(std::ifstream(path), text);
      // The owner writes after it has locked. A free lock belongs to a killed program.
      const bool dead = !text.empty() && flock(file, LOCK_SH | LOCK_NB) == 0;
      close(file);
      if (dead) {
        unlink(path.c_str());
        continue;
      }
      if (auto bus = parse_running_bus(text))
        found.push_back({entry.last_write_time(none), std::move(*bus)});
    }
  std::sort(found.begin(), found.end(),
            [](const Found& one, const Found& other) { return one.at > other.at; });
  std::vector<RunningBus> buses;
  for (Found& each : found)
    buses.push_back(std::move(each.bus));
  return buses;
}

std::vector<std::string> audit_files() {
  std::vector<std::filesystem::directory_entry> found;
  std::error_code none;
  for (const std::string& folder :
       std::set<std::string>{own_folder(), temporary_folder(), kServiceFolder})
    for (const auto& run : std::filesystem::directory_iterator(folder, none))
      for (const auto& file : std::filesystem::directory_iterator(run.path(), none))
        if (file.path().extension() == ".audit")
          found.push_back(file);
  std::sort(found.begin(), found.end(), [&](const auto& one, const auto& other) {
    return one.last_write_time(none) > other.last_write_time(none);
  });
  std::vector<std::string> files;
  for (const auto& file : found)
    files.push_back(file.path());
  return files;
}

std::string log_of(const std::string& name) {
  return own_folder() + "/" + name + ".log";
}

ProgramLocks::~ProgramLocks() {
  for (const int file : locks_)
    close(file);
}

void ProgramLocks::hold(const std::string& program, const std::string& robot, unsigned domain,
                        const std::string& holder) {
  const std::string folder = own_folder() + "/programs";
  make_own(folder);
  const std::string path = folder + "/" + program + "-" + robot + "-" + std::to_string(domain);
  const int file = lock(path);
  if (file < 0) {
    std::string other;
    std::getline(std::ifstream(path), other);
    throw std::runtime_error(program + " of robot " + robot + " in domain " +
                             std::to_string(domain) + " runs on this machine already" +
                             (other.empty() ? "" : ", started by " + other) +
                             ": stop that one, or take another --robot or --domain");
  }
  locks_.push_back(file);
  fill(file, path, holder);
}

}  // namespace saphira::cli
