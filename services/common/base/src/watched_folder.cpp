#include "saphira/base/watched_folder.hpp"

#include <sys/stat.h>

#include <filesystem>
#include <system_error>
#include <utility>

namespace saphira {

namespace fs = std::filesystem;

WatchedFolder::WatchedFolder(std::string path, std::string extension)
    : path_(std::move(path)), extension_(std::move(extension)) {}

WatchedFolder::Changes WatchedFolder::poll() {
  Changes changes;
  std::error_code error;
  fs::directory_iterator entries(path_, error);
  if (error) {
    changes.missing = true;
    return changes;
  }
  std::map<std::string, Stamp> there;
  for (; entries != fs::directory_iterator(); entries.increment(error)) {
    if (error)
      break;
    const fs::directory_entry& entry = *entries;
    std::error_code gone;  // an editor may have replaced it in this moment
    // An editor and a copy from another system leave hidden files.
    if (entry.path().filename().string().starts_with('.') ||
        entry.path().extension() != extension_ || !entry.is_regular_file(gone))
      continue;
    struct stat file {};
    if (stat(entry.path().c_str(), &file) != 0)
      continue;
    const auto nanoseconds = [](const timespec& time) {
      return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
    };
    there[entry.path().filename().string()] = {nanoseconds(file.st_mtim), nanoseconds(file.st_ctim),
                                               file.st_ino,
                                               static_cast<std::uint64_t>(file.st_size)};
  }
  for (const auto& [name, stamp] : there) {
    const auto before = known_.find(name);
    if (before == known_.end() || !(before->second == stamp))
      changes.changed.push_back(name);
  }
  for (const auto& [name, stamp] : known_)
    if (!there.contains(name))
      changes.gone.push_back(name);
  known_ = std::move(there);
  return changes;
}

std::string WatchedFolder::path_of(const std::string& name) const {
  return (fs::path(path_) / name).string();
}

}  // namespace saphira
