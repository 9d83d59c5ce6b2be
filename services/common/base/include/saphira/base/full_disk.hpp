#pragma once

#include <cerrno>
#include <stdexcept>
#include <string>
#include <string_view>

#include "saphira/base/text.hpp"

namespace saphira {

/// True for an errno of a full disk.
inline bool is_full(int why) {
  return why == ENOSPC || why == EDQUOT;
}

/// cannot_be() as an exception: UnusableFile, but std::runtime_error where the disk is full, since
/// that is no mistake of a person, and passes.
[[noreturn]] inline void fail_to_be(const std::string& path, std::string_view done,
                                    const std::string& more = {}) {
  const bool passes = is_full(errno);
  const std::string text = cannot_be(path, done) + more;
  if (passes)
    throw std::runtime_error(text);
  throw UnusableFile(text);
}

}  // namespace saphira
