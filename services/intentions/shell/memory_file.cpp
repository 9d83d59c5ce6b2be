#include "intentions/shell/memory_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "saphira/base/text.hpp"

namespace saphira::intentions {

MemoryFile::MemoryFile(std::string path, std::size_t most) : path_(std::move(path)) {
  if (path_.empty())
    return;
  if (std::filesystem::exists(path_))
    memory_ = read_journal(path_, read_file(path_));
  std::vector<Ending>& endings = memory_.endings;
  if (endings.size() > most)
    endings.erase(endings.begin(), endings.end() - static_cast<std::ptrdiff_t>(most));
  // Written beside it and moved over it: a crash in between leaves the old one whole.
  const std::string fresh = path_ + ".new";
  file_.reset(std::fopen(fresh.c_str(), "we"));
  // Without a buffer, what could not be written is not tried again behind what comes next.
  bool good = file_ != nullptr && std::setvbuf(file_.get(), nullptr, _IONBF, 0) == 0;
  std::string lines;
  for (const Placement& placement : memory_.placements)
    lines += write_line(placement);
  for (const Ending& ending : endings)
    lines += write_line(ending);
  good = good && append(lines);
  if (!good || std::rename(fresh.c_str(), path_.c_str()) != 0)
    throw std::runtime_error(path_ + ": cannot be written: " + std::strerror(errno));
}

bool MemoryFile::append(const std::string& lines) {
  if (!file_ || std::fwrite(lines.data(), 1, lines.size(), file_.get()) == lines.size()) {
    size_ += static_cast<long>(lines.size());
    return true;
  }
  // On a full disk: half a line must not be the beginning of the next one.
  const int why = errno;
  std::clearerr(file_.get());
  if (::ftruncate(::fileno(file_.get()), size_) == 0)
    std::fseek(file_.get(), size_, SEEK_SET);
  errno = why;
  return false;
}

}  // namespace saphira::intentions
