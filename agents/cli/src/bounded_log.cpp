#include "saphira/cli/bounded_log.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>

namespace saphira::cli {

void BoundedLog::keep_bounded() const {
  struct stat info {};
  if (fstat(descriptors_.front(), &info) != 0 || info.st_size < most_)
    return;
  std::rename(path_.c_str(), (path_ + ".old").c_str());
  const int file = open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (file < 0) {  // its folder has gone
    [[maybe_unused]] const int emptied = ftruncate(descriptors_.front(), 0);
    return;
  }
  for (const int descriptor : descriptors_)
    dup2(file, descriptor);
  close(file);
}

}  // namespace saphira::cli
