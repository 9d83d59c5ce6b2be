#include "run_folder.hpp"

#include <fcntl.h>
#include <pwd.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "saphira/base/archive.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/text.hpp"

namespace saphira::cli {

namespace {

// Of saphira@.service.
constexpr const char* kServiceFolder = "/var/lib/saphira";
constexpr const char* kServiceUser = "saphira";

/// Advice for a folder that cannot be used.
constexpr const char* kElsewhere =
    "; the variable SAPHIRA_RUN names another folder for what runs (usual: "
    "~/.local/state/saphira/HOST)";
constexpr std::size_t kLongestFolder = 60;  ///< of a socket in it at most 107

bool is_folder_of(uid_t user, const std::string& path) {
  struct stat info {};
  return lstat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode) && info.st_uid == user;
}

/// Makes a private folder; one of another owner is refused.
void make_own(const std::string& path) {
  if (mkdir(path.c_str(), 0700) != 0 && errno != EEXIST)
    throw std::runtime_error(cannot_be(path, "made") + kElsewhere);
  if (!is_folder_of(getuid(), path))
    throw std::runtime_error(path + ": expected a folder of this user" + kElsewhere);
}

/// For a user without a home. A cleaner of /tmp may remove it while its programs run.
std::string temporary_folder() {
  return "/tmp/saphira-" + std::to_string(getuid());
}

/// A folder in memory, for files that others have to find while the disk is full.
std::string memory_folder(uid_t user) {
  return "/dev/shm/saphira-" + std::to_string(user);
}

/// For the text of the lock in such a folder.
std::string memory_file(const std::filesystem::path& folder) {
  return memory_folder(getuid()) + "/" + folder.filename().string();
}

/// True where the file and the folder around it have the same owner: nobody else has put it there.
bool is_of_folder(int file, const std::filesystem::path& folder) {
  struct stat info {};
  return fstat(file, &info) == 0 && S_ISREG(info.st_mode) && is_folder_of(info.st_uid, folder);
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

std::string chosen_folder() {
  const char* const given = std::getenv("SAPHIRA_RUN");
  std::string ours = given != nullptr && *given != '\0' ? std::string(given) : folder_in_home();
  return ours.empty() ? temporary_folder() : ours;
}

/// The folder of this user, for all deployments. It has to outlast what runs.
std::string own_folder() {
  const std::string ours = chosen_folder();
  make_own(ours);
  return ours;
}

/// The folders of this user's deployments. One that was started without a home is in the second
/// folder. Nothing is made, so that a stop needs no room on the disk.
std::set<std::string> own_folders() {
  std::set<std::string> folders{chosen_folder(), temporary_folder()};
  if (!is_folder_of(getuid(), temporary_folder()))
    folders.erase(temporary_folder());  // another user's
  return folders;
}

/// Those, and where others on this machine may be, with what they keep in memory.
std::set<std::string> all_folders() {
  std::set<std::string> folders = own_folders();
  folders.insert(kServiceFolder);
  const passwd* const service = getpwnam(kServiceUser);
  for (const uid_t user : {getuid(), service == nullptr ? getuid() : service->pw_uid})
    if (is_folder_of(user, memory_folder(user)))
      folders.insert(memory_folder(user));
  return folders;
}

/// The locks of this process, and those of the version before it.
std::set<int>& held() {
  static std::set<int> all;
  return all;
}
std::set<int>& inherited() {
  static std::set<int> all;
  return all;
}

/// Locks an open file, or takes the descriptor over by which this process holds it already. -1: it
/// is held by another process.
int lock_open(int file) {
  struct stat info {};
  fstat(file, &info);
  for (const int kept : inherited()) {
    struct stat other {};
    if (fstat(kept, &other) != 0 || other.st_ino != info.st_ino || other.st_dev != info.st_dev)
      continue;
    close(file);
    inherited().erase(kept);
    held().insert(kept);
    return kept;
  }
  if (flock(file, LOCK_EX | LOCK_NB) == 0) {
    held().insert(file);
    return file;
  }
  close(file);
  return -1;
}
void unlock(int file) {
  held().erase(file);
  close(file);
}

/// Opens and locks it; -1 when another process holds the lock. std::runtime_error where it cannot
/// be opened.
int lock(const std::string& path) {
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (file < 0)
    throw std::runtime_error(cannot_be(path, "written") + kElsewhere);
  return lock_open(file);
}

}  // namespace

RunFolder::RunFolder() {
  const auto made = [this](const std::string& folder) {
    path_ = folder + "/temporary-XXXXXX";
    return mkdtemp(path_.data()) != nullptr;
  };
  if ((is_folder_of(getuid(), chosen_folder()) && made(chosen_folder())) ||
      (make_own(chosen_folder()), made(chosen_folder())))
    return;
  const std::string trouble = cannot_be(path_, "made") + kElsewhere;
  make_own(memory_folder(getuid()));
  if (!made(memory_folder(getuid())))
    throw std::runtime_error(trouble);
}

RunFolder::RunFolder(const std::string& name, const std::string& robot, unsigned domain) {
  path_ = own_folder() + "/" + name;
  make_own(path_);
  lock_ = lock(path_ + "/lock");
  if (lock_ < 0)
    throw std::runtime_error("this deployment is running already: " + path_ +
                             "/lock is held; saphira stop ends it");
  text_ = std::to_string(getpid()) + " " + std::to_string(domain) + " " + robot;
  tell();
}

void RunFolder::tell() {
  if (text_.empty())
    return;
  if (overwrite(lock_, text_)) {
    text_.clear();
    return;
  }
  // The text of an earlier lock is not ours.
  overwrite(lock_, "");
  mkdir(memory_folder(getuid()).c_str(), 0755);
  if (!is_folder_of(getuid(), memory_folder(getuid())))
    return;
  in_memory_ = memory_file(path_);
  const int file = open(in_memory_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (file >= 0) {
    overwrite(file, text_);
    close(file);
  }
}

RunFolder::~RunFolder() {
  if (!in_memory_.empty())
    unlink(in_memory_.c_str());
  if (lock_ >= 0) {
    unlock(lock_);
  } else {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
}

std::vector<Running> running_deployments() {
  std::vector<Running> all;
  std::error_code none;
  for (const std::string& folder : own_folders())
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
      const std::string path = entry.path() / "lock";
      const int file = open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
      if (file < 0)
        continue;
      if (!is_folder_of(getuid(), entry.path()) || !is_of_folder(file, entry.path())) {
        close(file);
        continue;
      }
      // A free lock means that no process runs it.
      if (const int free = lock_open(file); free >= 0) {
        unlock(free);
        continue;
      }
      Running running{entry.path().filename(), 0, {}, 0};
      std::error_code gone;
      const bool told = std::filesystem::file_size(path, gone) > 0;
      if (!told && !is_folder_of(getuid(), memory_folder(getuid())))
        continue;
      std::ifstream in(told ? path : memory_file(entry.path()));
      in >> running.pid >> running.domain >> std::ws;
      std::getline(in, running.robot);
      if (running.pid > 0)
        all.push_back(running);
    }
  return all;
}

FoundBus::FoundBus(const RunningBus& bus) {
  const std::string text = saved(bus) + "\n";
  for (const std::string& folder : {chosen_folder(), memory_folder(getuid())}) {
    // Readable for others on this machine: a service has another user than the people who command
    // it.
    mkdir(folder.c_str(), 0755);
    if (!is_folder_of(getuid(), folder))
      continue;
    mkdir((folder + "/buses").c_str(), 0755);
    path_ = folder + "/buses/" + bus.robot + "-" + std::to_string(bus.domain) + "-" +
            std::to_string(getpid());
    lock_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (lock_ >= 0)
      lock_ = lock_open(lock_);
    if (lock_ >= 0 && overwrite(lock_, text))
      return;
    end();
  }
}

FoundBus::~FoundBus() {
  end();
}

void FoundBus::end() {
  if (lock_ < 0)
    return;
  unlink(path_.c_str());
  unlock(std::exchange(lock_, -1));
}

std::vector<RunningBus> running_buses() {
  struct Found {
    std::filesystem::file_time_type at;
    RunningBus bus;
  };
  std::vector<Found> found;
  std::error_code none;
  for (const std::string& folder : all_folders())
    for (const auto& entry : std::filesystem::directory_iterator(folder + "/buses", none)) {
      const std::string path = entry.path();
      const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
      if (file < 0)
        continue;
      if (!is_of_folder(file, folder + "/buses")) {
        close(file);
        continue;
      }
      std::string text;
      std::getline(std::ifstream(path), text);
      // The owner writes after it has locked. A free lock belongs to a killed program.
      const bool dead = !text.empty() && flock(file, LOCK_SH | LOCK_NB) == 0;
      close(file);
      if (dead) {
        unlink(path.c_str());
        continue;
      }
      try {
        found.push_back({entry.last_write_time(none), restored<RunningBus>(text)});
      } catch (const std::runtime_error&) {  // of another version, or not whole yet
        continue;
      }
    }
  std::ranges::sort(found, [](const Found& one, const Found& other) { return one.at > other.at; });
  std::vector<RunningBus> buses;
  for (Found& each : found)
    buses.push_back(std::move(each.bus));
  return buses;
}

namespace {

/// True for a deployment's folder FILE-ROBOT-DOMAIN of that bus.
bool is_of(const std::string& name, const FilesOf& bus) {
  const std::size_t dash = name.rfind('-');
  return dash != std::string::npos && (bus.domain.empty() || name.substr(dash + 1) == bus.domain) &&
         (bus.robot.empty() || name.substr(0, dash).ends_with("-" + bus.robot));
}

/// The files with that ending in `folder` of each run folder of that bus, the newest first.
std::vector<std::string> newest_files(const std::string& folder, const std::string& ending,
                                      const FilesOf& bus) {
  std::vector<std::filesystem::directory_entry> found;
  std::error_code none;
  for (const std::string& all : all_folders())
    for (const auto& run : std::filesystem::directory_iterator(all, none))
      for (const auto& file : std::filesystem::directory_iterator(run.path() / folder, none))
        if (file.path().extension() == ending && is_of(run.path().filename(), bus))
          found.push_back(file);
  std::ranges::sort(found, [&](const auto& one, const auto& other) {
    return one.last_write_time(none) > other.last_write_time(none);
  });
  std::vector<std::string> files;
  for (const auto& file : found)
    files.push_back(file.path());
  return files;
}

}  // namespace

std::string words_of(const FilesOf& bus) {
  return (bus.robot.empty() ? "" : " of robot " + bus.robot) +
         (bus.domain.empty() ? "" : " in domain " + bus.domain);
}

std::vector<std::string> audit_files(const FilesOf& bus) {
  return newest_files("", ".audit", bus);
}

std::vector<std::string> box_files(const FilesOf& bus) {
  return newest_files("box", ".mcap", bus);
}

std::string keep_held() {
  std::string text;
  for (const int file : held()) {
    fcntl(file, F_SETFD, 0);
    text += std::to_string(file) + " ";
  }
  return text;
}

void take_held(const std::string& descriptors) {
  std::istringstream in(descriptors);
  for (int file = -1; in >> file;) {
    fcntl(file, F_SETFD, FD_CLOEXEC);
    inherited().insert(file);
  }
}

std::string log_of(const std::string& name) {
  return own_folder() + "/" + name + ".log";
}

ProgramLocks::~ProgramLocks() {
  for (const int file : locks_)
    unlock(file);
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
  overwrite(file, holder);  // without room the refusal of a second one names none
}

}  // namespace saphira::cli
