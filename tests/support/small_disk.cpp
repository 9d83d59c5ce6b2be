#include "small_disk.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <unistd.h>

#include <array>
#include <utility>

namespace saphira::test {

SmallDisk::SmallDisk(std::string folder)
    : folder_(std::move(folder)),
      works_(unshare(CLONE_NEWNS) == 0 &&
             mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
             mount("none", folder_.c_str(), "tmpfs", 0, "size=256k") == 0) {}

void SmallDisk::fill() const {
  const int file = open(path("filler").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  const std::array<char, 4096> zeros{};
  while (write(file, zeros.data(), zeros.size()) > 0) {
  }
  close(file);
}

void SmallDisk::make_room() const {
  unlink(path("filler").c_str());
}

}  // namespace saphira::test
