#include "held.hpp"

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <cstdio>
#include <stdexcept>

#include "saphira/base/full_disk.hpp"
#include "saphira/base/text.hpp"
#include "saphira/recorder/recording.hpp"

namespace saphira::recorder {

namespace {

void check_replaced(const std::string& file, bool overwrite) {
  try {
    std::ifstream in(file, std::ios::binary);
    if (in.peek() == std::ifstream::traits_type::eof())
      return;
    Reader begins(in);
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument(
        file + ": a file with other content is there; give a new name, such as NAME.mcap");
  }
  if (!overwrite)
    throw std::invalid_argument(file + ": a recording is there; give a new name, or --overwrite");
}

}  // namespace

Descriptor Held::locked(const std::string& path, int flags) const {
  Descriptor fd(open(path.c_str(), O_RDWR | O_CLOEXEC | flags, 0644));
  if (fd < 0 && errno != ENOENT)
    throw std::invalid_argument(cannot_be(file_, "written"));
  if (fd >= 0 && flock(fd, LOCK_EX | LOCK_NB) != 0)
    throw std::invalid_argument(file_ + ": another recorder writes it; give a new name");
  return fd;
}

Held::Held(const std::string& file, bool overwrite) : file_(file), new_(file + ".new") {
  if (!file.ends_with(".mcap"))
    throw std::invalid_argument(
        file + ": expected a name that ends with .mcap, the kind of file that this writes");
  before_ = locked(file, 0);
  if (before_ >= 0)
    check_replaced(file, overwrite);
  lock_ = locked(new_, O_CREAT);
  if (lock_ < 0)
    throw std::invalid_argument(cannot_be(file, "written"));
  out_.open(new_, std::ios::binary);
  if (!out_)
    fail_to_be(file, "written");
}

Held::~Held() {
  if (!is_kept_)
    std::remove(new_.c_str());
}

void Held::keep() {
  if (!is_kept_ && std::rename(new_.c_str(), file_.c_str()) != 0)
    fail_to_be(file_, "written");
  is_kept_ = true;
}

}  // namespace saphira::recorder
