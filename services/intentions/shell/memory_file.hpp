#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "saphira/base/durable.hpp"
#include "saphira/intentions/journal.hpp"

namespace saphira::intentions {

/// The journal on a disk, with the progress of the open goals (FILE.work) and the journal's number
/// of lines (FILE.lines), which reveals a truncated journal. A killed service loses nothing; a
/// power cut may lose the last few lines, since nothing waits for the disk.
class MemoryFile {
 public:
  /// Reads the file and begins it anew, without superseded lines and with the newest `most`
  /// endings. A damaged file is set aside; its readable lines count. An empty path saves nothing.
  /// std::runtime_error where it cannot be written, std::invalid_argument where it is another
  /// file.
  explicit MemoryFile(std::string path, std::size_t most = kMostEndings,
                      Files files = Files::kChange);

  const Memory& memory() const { return memory_; }
  /// The damage, in words.
  const std::vector<std::string>& troubles() const { return troubles_; }
  bool keeps() const { return !path_.empty(); }
  /// Replaces the saved work. False where it could not be written.
  bool keep(const Work& work) const;
  /// False where it could not be written: then none of it is there. A file of more than twice
  /// `most` lines is begun anew as at the start: a service that runs for months does not fill the
  /// disk.
  bool append(const std::string& lines);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  /// Writes the lines to keep to a new file and replaces the old one.
  bool begin(Memory& memory);
  void begin_anew();
  bool keep_count(std::size_t lines) const;

  std::string path_;
  std::size_t most_;
  Files files_;
  std::size_t lines_ = 0;
  std::size_t begin_anew_at_ = 0;  ///< lines
  Memory memory_;
  std::vector<std::string> troubles_;
  std::unique_ptr<std::FILE, Close> file_;
  long size_ = 0;  ///< of the completely written part
};

}  // namespace saphira::intentions
