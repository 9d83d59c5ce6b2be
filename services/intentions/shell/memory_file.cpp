#include "intentions/shell/memory_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "saphira/base/durable.hpp"
#include "saphira/base/text.hpp"

namespace saphira::intentions {
namespace {

constexpr const char* kWork = ".work";

}  // namespace

MemoryFile::MemoryFile(std::string path, std::size_t most) : path_(std::move(path)), most_(most) {
  if (path_.empty())
    return;
  const auto note = [this](std::string trouble) {
    if (!trouble.empty())
      troubles_.push_back(std::move(trouble));
  };
  note(read_or_set_aside(path_, [this](const std::string& content) {
    std::vector<FileError> damaged;
    memory_ = read_journal(path_, content, damaged);
    if (!damaged.empty())
      throw std::runtime_error(std::to_string(damaged.size()) +
                               " of its lines are damaged, the others count; the first:\n" +
                               damaged.front().what());
  }));
  note(read_or_set_aside(path_ + kWork, [this](const std::string& content) {
    memory_.work = read_work(path_ + kWork, unsealed(content, path_ + kWork));
  }));
  if (!begin(memory_))
    throw std::runtime_error(path_ + ": cannot be written: " + std::strerror(errno));
}

bool MemoryFile::begin(Memory& memory) {
  std::vector<Ending>& endings = memory.endings;
  if (endings.size() > most_)
    endings.erase(endings.begin(), endings.end() - static_cast<std::ptrdiff_t>(most_));
  // Written beside it and moved over it: a crash in between leaves the old one whole.
  const std::string fresh = path_ + ".new";
  std::unique_ptr<std::FILE, Close> file(std::fopen(fresh.c_str(), "we"));
  // Without a buffer, what could not be written is not tried again behind what comes next.
  if (!file || std::setvbuf(file.get(), nullptr, _IONBF, 0) != 0)
    return false;
  std::string lines;
  for (const Placement& placement : memory.placements)
    lines += write_line(placement);
  for (const Ending& ending : endings)
    lines += write_line(ending);
  if (std::fwrite(lines.data(), 1, lines.size(), file.get()) != lines.size() ||
      std::rename(fresh.c_str(), path_.c_str()) != 0)
    return false;
  file_ = std::move(file);
  size_ = static_cast<long>(lines.size());
  lines_ = memory.placements.size() + endings.size();
  return true;
}

void MemoryFile::begin_anew() {
  // Where that fails, on a full disk, the file goes on as it is until it has grown as much again.
  lines_ = 0;
  try {
    std::vector<FileError> damaged;
    Memory memory = read_journal(path_, read_file(path_), damaged);
    begin(memory);
  } catch (const std::exception&) {
    return;
  }
}

bool MemoryFile::keep(const Work& work) const {
  return path_.empty() || replace_file(path_ + kWork, sealed(write_work(work)));
}

bool MemoryFile::append(const std::string& lines) {
  if (!file_ || std::fwrite(lines.data(), 1, lines.size(), file_.get()) == lines.size()) {
    size_ += static_cast<long>(lines.size());
    lines_ += static_cast<std::size_t>(std::count(lines.begin(), lines.end(), '\n'));
    if (file_ && lines_ > 2 * most_)
      begin_anew();
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
