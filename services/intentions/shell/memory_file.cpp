#include "intentions/shell/memory_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "saphira/base/archive.hpp"
#include "saphira/base/text.hpp"

namespace saphira::intentions {
namespace {

constexpr const char* kWork = ".work";
constexpr const char* kLines = ".lines";

std::size_t lines_of(const std::string& content) {
  return static_cast<std::size_t>(std::count(content.begin(), content.end(), '\n'));
}

}  // namespace

MemoryFile::MemoryFile(std::string path, std::size_t most, Files files)
    : path_(std::move(path)), most_(most), files_(files) {
  if (path_.empty())
    return;
  const auto read = [this](const std::string& file, const auto& understand) {
    std::string trouble = read_or_set_aside(file, understand, files_);
    if (!trouble.empty())
      troubles_.push_back(std::move(trouble));
  };
  std::size_t expected = 0;
  read(path_ + kLines, [&](const std::string& content) {
    expected = restored<std::size_t>(unsealed(content, path_ + kLines));
  });
  bool found = false;
  read(path_, [&](const std::string& content) {
    found = true;
    std::vector<FileError> damaged;
    memory_ = read_journal(path_, content, damaged);
    if (!damaged.empty())
      throw std::runtime_error(std::to_string(damaged.size()) +
                               " of its lines are damaged, the others count; the first:\n" +
                               damaged.front().what());
    if (lines_of(content) < expected)
      throw std::runtime_error("it has " + std::to_string(lines_of(content)) + " of its " +
                               std::to_string(expected) + " lines: its end is missing");
  });
  if (!found && expected > 0)
    troubles_.push_back(path_ + " is gone, or empty: it had " + std::to_string(expected) +
                        " lines");
  read(path_ + kWork, [this](const std::string& content) {
    memory_.work = restored<Work>(unsealed(content, path_ + kWork));
  });
  memory_.condition = !troubles_.empty()                        ? Memory::Condition::kDamaged
                      : found || std::filesystem::exists(path_) ? Memory::Condition::kWhole
                                                                : Memory::Condition::kNone;
  if (!begin(memory_))
    throw std::runtime_error(cannot_be(path_, "written"));
}

bool MemoryFile::begin(Memory& memory) {
  std::vector<Ending>& endings = memory.endings;
  if (endings.size() > most_)
    endings.erase(endings.begin(), endings.end() - static_cast<std::ptrdiff_t>(most_));
  if (files_ == Files::kStay)
    return can_replace_file(path_, files_);
  // Written to a new file and renamed: a crash in between leaves the old file whole.
  const std::string fresh = path_ + ".new";
  std::unique_ptr<std::FILE, Close> file(std::fopen(fresh.c_str(), "we"));
  // Without a buffer, so that failed data are not written again before later ones.
  if (!file || std::setvbuf(file.get(), nullptr, _IONBF, 0) != 0)
    return false;
  std::string lines;
  for (const Placement& placement : memory.placements)
    lines += write_line(placement);
  for (const Ending& ending : endings)
    lines += write_line(ending);
  const std::size_t count = memory.placements.size() + endings.size();
  // Before the journal has fewer lines than its count.
  if (std::fwrite(lines.data(), 1, lines.size(), file.get()) != lines.size() ||
      !keep_count(count) || std::rename(fresh.c_str(), path_.c_str()) != 0)
    return false;
  file_ = std::move(file);
  size_ = static_cast<long>(lines.size());
  lines_ = count;
  begin_anew_at_ = 2 * most_;
  return true;
}

bool MemoryFile::keep_count(std::size_t lines) const {
  return replace_file(path_ + kLines, sealed(saved(lines)));
}

void MemoryFile::begin_anew() {
  // If that fails, on a full disk, the file goes on until it has grown as much again.
  begin_anew_at_ = lines_ + 2 * most_;
  try {
    std::vector<FileError> damaged;
    Memory memory = read_journal(path_, read_bytes(path_), damaged);
    begin(memory);
  } catch (const std::exception&) {
    return;
  }
}

bool MemoryFile::keep(const Work& work) const {
  return path_.empty() || files_ == Files::kStay ||
         replace_file(path_ + kWork, sealed(saved(work)));
}

bool MemoryFile::append(const std::string& lines) {
  if (!file_ || std::fwrite(lines.data(), 1, lines.size(), file_.get()) == lines.size()) {
    size_ += static_cast<long>(lines.size());
    lines_ += lines_of(lines);
    if (file_ && lines_ > begin_anew_at_)
      begin_anew();
    return !file_ || keep_count(lines_);
  }
  // On a full disk: half a line must not become the beginning of the next one.
  const int why = errno;
  std::clearerr(file_.get());
  if (::ftruncate(::fileno(file_.get()), size_) == 0)
    std::fseek(file_.get(), size_, SEEK_SET);
  errno = why;
  return false;
}

}  // namespace saphira::intentions
