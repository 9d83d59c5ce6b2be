#pragma once

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <deque>
#include <optional>
#include <string>

namespace saphira::cli {

/// The lines of standard input, as they come; blank lines are left out. Never waits.
class InputLines {
 public:
  /// Nothing: none has come yet, or there is no other.
  std::optional<std::string> next() {
    read();
    if (lines_.empty())
      return std::nullopt;
    std::string line = lines_.front();
    lines_.pop_front();
    return line;
  }
  bool ended() const { return lines_.empty() && ended_; }

 private:
  void read() {
    std::array<char, 4096> buffer{};
    pollfd fd{STDIN_FILENO, POLLIN, 0};
    while (!ended_ && poll(&fd, 1, 0) > 0) {
      const ssize_t n = ::read(STDIN_FILENO, buffer.data(), buffer.size());
      ended_ = n <= 0;
      text_.append(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    }
    if (ended_ && !text_.empty() && text_.back() != '\n')
      text_ += '\n';
    for (std::size_t end = 0; (end = text_.find('\n')) != std::string::npos;
         text_.erase(0, end + 1))
      if (text_.find_first_not_of(" \t\r") < end)
        lines_.push_back(text_.substr(0, end));
  }

  bool ended_ = false;
  std::string text_;
  std::deque<std::string> lines_;
};

}  // namespace saphira::cli
