#pragma once

#include <sys/types.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

namespace saphira::console {

/// A running Chromium without a display, controlled by its DevTools protocol: JSON texts that end
/// with a zero byte, on its descriptors 3 and 4. std::runtime_error without Chromium, and where a
/// command fails.
class Browser {
 public:
  Browser();
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Opens a page with a window of this size; the following commands are for it.
  void open(int width, int height, bool telephone = false);
  void go(const std::string& address);
  nlohmann::json call(const std::string& method,
                      const nlohmann::json& parameters = nlohmann::json::object());
  /// The value of a JavaScript expression in the page.
  nlohmann::json value(const std::string& expression);
  /// Waits until an expression is true. False where it is not within 20 s.
  bool wait(const std::string& expression);

 private:
  using Clock = std::chrono::steady_clock;
  std::string read_text(Clock::time_point end);

  std::string folder_;
  std::string session_;
  std::string received_;
  pid_t pid_ = -1;
  int to_ = -1;
  int from_ = -1;
  int id_ = 0;
};

}  // namespace saphira::console
