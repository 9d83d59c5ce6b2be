#include "intentions/shell/memory_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "saphira/base/text.hpp"

namespace saphira::intentions {

MemoryFile::MemoryFile(std::string path) : path_(std::move(path)) {
  if (path_.empty())
    return;
  if (std::filesystem::exists(path_))
    memory_ = read_journal(path_, read_file(path_));
  // Written beside it and moved over it: a crash in between leaves the old one whole.
  const std::string fresh = path_ + ".new";
  file_.reset(std::fopen(fresh.c_str(), "we"));
  bool good = file_ != nullptr;
  for (const Placement& placement : memory_.placements)
    good = good && append(write_line(placement));
  for (const Ending& ending : memory_.endings)
    good = good && append(write_line(ending));
  if (!good || std::rename(fresh.c_str(), path_.c_str()) != 0)
    throw std::runtime_error(path_ + ": cannot be written: " + std::strerror(errno));
}

bool MemoryFile::append(const std::string& lines) {
  if (!file_)
    return true;
  return std::fwrite(lines.data(), 1, lines.size(), file_.get()) == lines.size() &&
         std::fflush(file_.get()) == 0;
}

}  // namespace saphira::intentions
