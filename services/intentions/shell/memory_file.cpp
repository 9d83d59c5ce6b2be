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

std::string lines_of(const std::vector<Ending>& endings) {
  return joined(endings, "", [](const Ending& ending) { return sealed(saved(ending)); });
}

}  // namespace

MemoryFile::MemoryFile(std::string path, std::size_t most, Files files)
    : path_(std::move(path)), most_(most), files_(files) {
  if (path_.empty())
    return;
  const std::filesystem::path folder = std::filesystem::absolute(path_).parent_path();
  if (!std::filesystem::is_directory(folder))
    throw std::invalid_argument(
        path_ + ": expected a file in a folder that exists, and there is no " + folder.string());
  const bool first = !std::filesystem::exists(path_ + kWork);
  const auto read = [this](const std::string& file, const auto& understand) {
    std::string trouble = read_or_set_aside(file, understand, files_);
    if (!trouble.empty())
      troubles_.push_back(std::move(trouble));
  };
  read(path_ + kWork, [this](const std::string& content) {
    memory_.work = restored<Work>(unsealed(content, path_ + kWork));
  });
  bool found = false;
  read(path_, [&](const std::string& content) {
    found = true;
    read_endings(content);
  });
  if (!found && memory_.work.ended)
    troubles_.push_back(path_ + " is gone, or empty");
  memory_.condition = !troubles_.empty() ? Memory::Condition::kDamaged
                      : first            ? Memory::Condition::kNone
                                         : Memory::Condition::kWhole;
  if (!begin() || !keep(memory_.work))
    throw std::runtime_error(cannot_be(path_, "written"));
}

void MemoryFile::read_endings(std::string_view content) {
  std::vector<FileError> damaged;
  for (int number = 1; !content.empty(); ++number) {
    const std::string_view line = content.substr(0, content.find('\n') + 1);
    content.remove_prefix(line.empty() ? content.size() : line.size());
    try {
      memory_.endings.push_back(restored<Ending>(unsealed(line, path_)));
    } catch (const std::exception& error) {
      damaged.emplace_back(path_, number, 1, error.what(), line.substr(0, line.find('\n')));
    }
  }
  if (!damaged.empty())
    throw std::runtime_error(std::to_string(damaged.size()) +
                             " of its lines are damaged, the others count; the first:\n" +
                             damaged.front().what());
  if (const auto& newest = memory_.work.ended;
      newest && std::ranges::find(memory_.endings, *newest, &Ending::id) == memory_.endings.end())
    throw std::runtime_error("its end is missing");
}

bool MemoryFile::begin() {
  std::vector<Ending>& endings = memory_.endings;
  if (endings.size() > most_)
    endings.erase(endings.begin(), endings.end() - static_cast<std::ptrdiff_t>(most_));
  if (files_ == Files::kStay)
    return can_replace_file(path_, files_);
  const std::string lines = lines_of(endings);
  if (!replace_file(path_, lines))
    return false;
  file_.reset(std::fopen(path_.c_str(), "ae"));
  size_ = static_cast<long>(lines.size());
  // Without a buffer, so that failed data are not written again before later ones.
  return file_ && std::setvbuf(file_.get(), nullptr, _IONBF, 0) == 0;
}

bool MemoryFile::keep(const Work& work) const {
  return path_.empty() || files_ == Files::kStay ||
         replace_file(path_ + kWork, sealed(saved(work)));
}

bool MemoryFile::append(const std::vector<Ending>& endings) {
  if (path_.empty() || files_ == Files::kStay)
    return true;
  const std::string lines = lines_of(endings);
  if (file_ && std::fwrite(lines.data(), 1, lines.size(), file_.get()) == lines.size()) {
    size_ += static_cast<long>(lines.size());
    memory_.endings.insert(memory_.endings.end(), endings.begin(), endings.end());
    return memory_.endings.size() <= 2 * most_ || begin();
  }
  // On a full disk: half a line must not become the beginning of the next one.
  const int why = errno;
  if (file_ && ::ftruncate(::fileno(file_.get()), size_) == 0)
    std::clearerr(file_.get());
  errno = why;
  return false;
}

}  // namespace saphira::intentions
