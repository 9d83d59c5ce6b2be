#include "saphira/base/watched_folder.hpp"

#include <filesystem>
#include <system_error>
#include <utility>

namespace saphira {

namespace fs = std::filesystem;

WatchedFolder::WatchedFolder(std::string path, std::string extension)
    : path_(std::move(path)), extension_(std::move(extension)) {}

WatchedFolder::Changes WatchedFolder::look() {
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
    if (entry.path().extension() != extension_ || !entry.is_regular_file(gone))
      continue;
    Stamp stamp;
    stamp.time = entry.last_write_time(gone).time_since_epoch().count();
    stamp.size = gone ? 0 : entry.file_size(gone);
    if (!gone)
      there[entry.path().filename().string()] = stamp;
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
