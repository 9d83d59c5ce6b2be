#include "run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace saphira::cli {

namespace {

/// Makes a folder that only we can use; one that somebody else made for us is refused.
void make_own(const std::string& path) {
  mkdir(path.c_str(), 0700);
  struct stat info {};
  if (lstat(path.c_str(), &info) != 0 || !S_ISDIR(info.st_mode) || info.st_uid != getuid())
    throw std::runtime_error(path + " cannot be made, or is not ours");
}

}  // namespace

RunFolder::RunFolder() {
  path_ = "/tmp/saphira-demo-XXXXXX";
  if (mkdtemp(path_.data()) == nullptr)
    throw std::runtime_error("no temporary folder in /tmp");
}

RunFolder::RunFolder(const std::string& name) {
  const std::string ours = "/tmp/saphira-" + std::to_string(getuid());
  make_own(ours);
  path_ = ours + "/" + name;
  make_own(path_);
  lock_ = open((path_ + "/lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (lock_ < 0 || flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    if (lock_ >= 0)
      close(lock_);
    throw std::runtime_error("this deployment is running already: " + path_ + "/lock is held");
  }
}

RunFolder::~RunFolder() {
  if (lock_ >= 0) {
    close(lock_);
  } else {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
}

}  // namespace saphira::cli
