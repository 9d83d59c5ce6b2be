#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/base/durable.hpp"
#include "saphira/intentions/work.hpp"

namespace saphira::intentions {

/// The endings of goals on a disk, a line each, with the progress of the open goals (FILE.work),
/// which names the newest ending: that reveals a list without its end. A killed service loses
/// nothing; a power cut may lose the last few lines, since nothing waits for the disk.
class MemoryFile {
 public:
  /// Reads the file and begins it anew, with the newest `most` endings. A damaged file is set
  /// aside; its readable lines count. An empty path saves nothing. std::runtime_error where it
  /// cannot be written, std::invalid_argument where it is another file, or its folder does not
  /// exist.
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
  bool append(const std::vector<Ending>& endings);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void read_endings(std::string_view content);
  /// Replaces the file by one of the newest endings.
  bool begin();

  std::string path_;
  std::size_t most_;
  Files files_;
  Memory memory_;
  std::vector<std::string> troubles_;
  std::unique_ptr<std::FILE, Close> file_;
  long size_ = 0;  ///< of the completely written part
};

}  // namespace saphira::intentions
