#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "saphira/intentions/journal.hpp"

namespace saphira::intentions {

/// The journal on a disk, and beside it what has been done of the open goals (FILE.work) and how
/// many lines the journal has (FILE.lines), so that a journal that was cut is noticed. A killed
/// service loses nothing; a computer that loses its power may lose the last few lines, since
/// nothing waits for the disk.
class MemoryFile {
 public:
  /// Reads what is there and begins the file anew, without what has been superseded and with the
  /// newest `most` endings. What is damaged is set aside; what can be read of the journal counts.
  /// An empty path remembers nothing. std::runtime_error where it cannot be written.
  explicit MemoryFile(std::string path, std::size_t most = kMostEndings);

  const Memory& memory() const { return memory_; }
  /// The damage, in words.
  const std::vector<std::string>& troubles() const { return troubles_; }
  bool keeps() const { return !path_.empty(); }
  /// In the place of what was kept before. False where it could not be written.
  bool keep(const Work& work) const;
  /// False where it could not be written: then none of it is there. A file of more than twice
  /// `most` lines is begun anew as at the start: a service that runs for months does not fill the
  /// disk.
  bool append(const std::string& lines);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  /// Writes what is to be kept of it beside the file and puts that in its place.
  bool begin(Memory& memory);
  void begin_anew();
  bool keep_count(std::size_t lines) const;

  std::string path_;
  std::size_t most_;
  std::size_t lines_ = 0;
  std::size_t begin_anew_at_ = 0;  ///< lines
  Memory memory_;
  std::vector<std::string> troubles_;
  std::unique_ptr<std::FILE, Close> file_;
  long size_ = 0;  ///< of what has been written whole
};

}  // namespace saphira::intentions
