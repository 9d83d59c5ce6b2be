#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "saphira/intentions/journal.hpp"

namespace saphira::intentions {

/// The journal on a disk. A killed service loses nothing; a computer that loses its power may lose
/// the last few lines, since nothing waits for the disk.
class MemoryFile {
 public:
  /// Reads what is there and begins the file anew, without what has been superseded and with the
  /// newest `most` endings. An empty path remembers nothing.
  explicit MemoryFile(std::string path, std::size_t most = kMostEndings);

  const Memory& memory() const { return memory_; }
  /// False where it could not be written: then none of it is there.
  bool append(const std::string& lines);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::string path_;
  Memory memory_;
  std::unique_ptr<std::FILE, Close> file_;
  long size_ = 0;  ///< of what has been written whole
};

}  // namespace saphira::intentions
