#include "chunks.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

namespace saphira::web {

namespace {

constexpr std::size_t kLongestLine = 1024;

}  // namespace

bool Chunks::read(std::string_view line) {
  if (!line.ends_with('\r'))
    return false;
  line.remove_suffix(1);
  if (trailer_) {
    ended_ = line.empty();
    return true;
  }
  if (behind_chunk_) {
    behind_chunk_ = false;
    return line.empty();
  }
  const auto size = std::from_chars(line.data(), line.data() + line.size(), left_, 16);
  const std::string_view rest = line.substr(static_cast<std::size_t>(size.ptr - line.data()));
  trailer_ = left_ == 0;
  behind_chunk_ = !trailer_;
  return size.ec == std::errc() && (rest.empty() || rest.find_first_not_of(" \t;") != 0);
}

bool Chunks::take(std::string_view bytes, std::string& body) {
  while (!bytes.empty() && !ended_) {
    const std::size_t size = left_ > 0 ? std::min(left_, bytes.size()) : bytes.find('\n');
    if (left_ > 0) {
      body.append(bytes.substr(0, size));
      left_ -= size;
      bytes.remove_prefix(size);
      continue;
    }
    line_.append(bytes.substr(0, size));
    if (line_.size() > kLongestLine)
      return false;
    if (size == std::string_view::npos)
      return true;
    bytes.remove_prefix(size + 1);
    const std::string line = std::exchange(line_, {});
    if (!read(line))
      return false;
  }
  return true;
}

}  // namespace saphira::web
