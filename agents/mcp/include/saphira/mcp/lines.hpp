#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "saphira/mcp/session.hpp"

namespace saphira::mcp {

/// The messages of a stream, a line each. Pure.
class Lines {
 public:
  /// The lines that have ended since the last call. Of a line that is too long for a session comes
  /// the beginning, once, as one that is too long; the rest is skipped.
  std::vector<std::string> take(std::string_view bytes) {
    std::vector<std::string> lines;
    while (!bytes.empty()) {
      const std::size_t end = bytes.find('\n');
      const bool ends = end != std::string_view::npos;
      if (!skips_)
        line_ += bytes.substr(0, end);
      bytes.remove_prefix(ends ? end + 1 : bytes.size());
      if (line_.size() > Session::kLongestLine)
        skips_ = true;
      if (!line_.empty() && (ends || skips_))
        lines.push_back(std::exchange(line_, {}));
      skips_ = skips_ && !ends;
    }
    return lines;
  }

 private:
  std::string line_;
  bool skips_ = false;  ///< the rest of a line
};

}  // namespace saphira::mcp
