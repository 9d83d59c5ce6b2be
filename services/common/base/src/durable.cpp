#include "saphira/base/durable.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>

#include "saphira/base/descriptor.hpp"
#include "saphira/base/fnv1a.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"

namespace saphira {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSum = 8;  // hexadecimal digits
constexpr std::string_view kEarlierMark = "; memory of saphira\n";

std::string sum_of(std::string_view text) {
  Fnv1a hash;
  hash.add(text);
  return hash.text().substr(0, kSum);
}

class File {
 public:
  File(const std::string& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {}

  bool write(std::string_view text) const {
    if (fd_ < 0)
      return false;
    while (!text.empty()) {
      const ssize_t n = ::write(fd_, text.data(), text.size());
      if (n < 0)
        return false;
      text.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
  }
  bool opened() const { return fd_ >= 0; }
  bool sync() const { return ::fsync(fd_) == 0; }

 private:
  Descriptor fd_;
};

}  // namespace

std::string sealed(std::string_view text) {
  return sum_of(text) + " " + std::string(text) + "\n";
}

std::optional<std::string_view> unsealed(std::string_view text) {
  if (text.size() <= kSum + 1 || text[kSum] != ' ' || text.back() != '\n')
    return std::nullopt;
  const std::string_view inner = text.substr(kSum + 1, text.size() - kSum - 2);
  return sum_of(inner) == text.substr(0, kSum) ? std::optional(inner) : std::nullopt;
}

std::string_view unsealed(std::string_view text, const std::string& file) {
  if (const auto inner = unsealed(text))
    return *inner;
  throw FileError(file, 1, 1, "it is not as it was written: its sum is missing or wrong");
}

/// A sum and a blank, of which one letter may be wrong, or a part of a sum.
bool was_sealed(std::string_view content) {
  const std::string_view sum = content.substr(0, std::min(content.find('\n'), kSum));
  auto wrong = std::count_if(sum.begin(), sum.end(), [](char c) {
    return std::string_view("0123456789abcdef").find(c) == std::string_view::npos;
  });
  if (content.size() > sum.size() && content[sum.size()] != ' ')
    wrong += content[sum.size()] == '\n' ? 2 : 1;
  return wrong <= (content.size() > kSum ? 1 : 0) || content.starts_with(kEarlierMark) ||
         content.find_first_not_of('\0') == std::string_view::npos;
}

std::string read_or_set_aside(const std::string& path,
                              const std::function<void(const std::string& content)>& understand,
                              Files files) {
  std::error_code error;
  // An empty file was created and never written.
  if (!fs::is_regular_file(path, error) || fs::file_size(path, error) == 0)
    return {};
  std::string content;
  std::string why;
  try {
    content = read_bytes(path);
    understand(content);
    return {};
  } catch (const std::exception& trouble) {
    why = trouble.what();
  }
  if (!was_sealed(content))
    throw std::invalid_argument(path +
                                ": expected a file that this program has written, or a new name; "
                                "found another file, which stays as it is: " +
                                why);
  const std::string aside = path + ".damaged";
  if (files == Files::kStay)
    return path + " cannot be used; a start would set it aside as " + aside +
           ", and begin it anew: " + why;
  fs::rename(path, aside, error);
  return path + " cannot be used, and is begun anew" +
         (error ? " (it could not be set aside: " + error.message() + ")"
                : "; it is set aside as " + aside) +
         ": " + why;
}

namespace {

/// A device, a socket or a folder stays: a file in its place would break what uses it. Sets errno.
bool is_file_or_new(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_regular_file(status) || !fs::exists(status))
    return true;  // an unknown one fails at its name, with the system's reason
  errno = fs::is_directory(status) ? EISDIR : ENOTSUP;
  return false;
}

}  // namespace

bool can_replace_file(const std::string& path, Files files) {
  if (!is_file_or_new(path))
    return false;
  if (files == Files::kStay)
    return ::access(folder_of(path).c_str(), W_OK) == 0;
  const std::string fresh = path + ".new";
  if (!File(fresh, O_WRONLY | O_CREAT | O_TRUNC).opened())
    return false;
  ::unlink(fresh.c_str());
  return true;
}

bool replace_file(const std::string& path, std::string_view text, bool sync) {
  if (!is_file_or_new(path))
    return false;
  const std::string fresh = path + ".new";
  const auto written = [&] {
    const File file(fresh, O_WRONLY | O_CREAT | O_TRUNC);
    // The content before the name: otherwise a power cut may leave the name of an empty file.
    return file.write(text) && (!sync || file.sync());
  };
  if (!written() || std::rename(fresh.c_str(), path.c_str()) != 0) {
    const int why = errno;
    ::unlink(fresh.c_str());
    errno = why;
    return false;
  }
  if (!sync)
    return true;
  return File(folder_of(path), O_RDONLY | O_DIRECTORY).sync();
}

bool overwrite(int fd, std::string_view text) {
  const auto size = static_cast<ssize_t>(text.size());
  return ::pwrite(fd, text.data(), text.size(), 0) == size && ::ftruncate(fd, size) == 0;
}

}  // namespace saphira
