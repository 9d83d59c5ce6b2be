#include "latch_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "saphira/base/archive.hpp"
#include "saphira/base/descriptor.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/full_disk.hpp"
#include "saphira/base/text.hpp"

namespace saphira::bridge {
namespace {

constexpr const char* kRoomFile = ".room";
constexpr std::size_t kRoom = 4096;  // [bytes] more than any latches

/// The latches as earlier versions kept them.
struct Former {
  bool estopped = false;
  std::string estop_source;
  authority::Wait wait = authority::Wait::none;
};

authority::Latches latches_of(std::string_view text) {
  try {
    return restored<authority::Latches>(text);
  } catch (const std::exception&) {
    const auto former = restored<Former>(text);
    return {former.estopped, former.estop_source, former.wait};
  }
}

}  // namespace

authority::Latches LatchFile::read() const {
  std::error_code error;
  if (path_.empty() || (!std::filesystem::exists(path_, error) && !error))
    return {};
  try {
    return latches_of(unsealed(read_bytes(path_), path_));
  } catch (const std::exception&) {  // the file exists because of a latch
    return {.estopped = true,
            .estop_source = "unknown: the saved emergency stop cannot be read",
            .wait = authority::Wait::driven};
  }
}

std::string LatchFile::write(const authority::Latches& latches) {
  if (path_.empty())
    return {};
  unkept_ = latches == authority::Latches{} ? "" : sealed(saved(latches));
  if (!keep(*unkept_))
    return path_ + ": " + std::strerror(errno);
  unkept_.reset();
  return {};
}

void LatchFile::tend() {
  if (path_.empty())
    return;
  if (unkept_ && keep(*unkept_))
    unkept_.reset();
  std::error_code error;
  if (!std::filesystem::exists(path_ + kRoomFile, error))
    replace_file(path_ + kRoomFile, std::string(kRoom, ' '));
}

bool LatchFile::keep(const std::string& text) const {
  if (text.empty())
    return std::remove(path_.c_str()) == 0 || errno == ENOENT;
  if (replace_file(path_, text))
    return true;
  const int why = errno;
  const bool kept = is_full(why) && (fill(path_ + kRoomFile, text) || fill(path_, text));
  errno = why;
  return kept;
}

bool LatchFile::fill(const std::string& file, const std::string& text) const {
  const Descriptor fd = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  return overwrite(fd, text) && (file == path_ || std::rename(file.c_str(), path_.c_str()) == 0);
}

}  // namespace saphira::bridge
