#include "log.hpp"

#include <poll.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdint>
#include <string_view>

#include "saphira/base/boot_clock.hpp"
#include "saphira/base/log_line.hpp"

namespace saphira::bus::internal {
namespace {

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    auto made = std::make_shared<spdlog::logger>("saphira",
                                                 std::make_shared<spdlog::sinks::stderr_sink_mt>());
    made->set_pattern("%v");  // log_line gives the whole line
    made->flush_on(spdlog::level::debug);
    return made;
  }();
  return *instance;
}

struct Level {
  v1::LogLevel ours;
  std::string_view name;
  spdlog::level::level_enum theirs;
};
constexpr Level kLevels[] = {{v1::LOG_DEBUG, "debug", spdlog::level::debug},
                             {v1::LOG_INFO, "info", spdlog::level::info},
                             {v1::LOG_WARNING, "warning", spdlog::level::warn},
                             {v1::LOG_ERROR, "error", spdlog::level::err}};

void write(const Level& level, const std::string& program, const std::string& text) {
  if (logger().should_log(level.theirs))
    logger().log(level.theirs, log_line(unix_time(), level.name, program, text));
}

/// False while stderr would block: the terminal may be stopped, or the pipe unread, and a program
/// that holds a robot must not wait. A pipe that can be written to takes a line at once.
bool can_write() {
  pollfd ready{STDERR_FILENO, POLLOUT, 0};
  return ::poll(&ready, 1, 0) == 1 && (ready.revents & POLLOUT) != 0;
}

std::atomic<std::uint64_t> unwritten{0};

}  // namespace

void write_log(v1::LogLevel level, const std::string& program, const std::string& text) {
  if (level == v1::LOG_ERROR)
    has_erred() = true;
  if (!can_write()) {
    ++unwritten;
    return;
  }
  if (const std::uint64_t lines = unwritten.exchange(0); lines > 0)
    write(kLevels[2], program, std::to_string(lines) + " lines are missing here: nobody read on");
  for (const Level& known : kLevels)
    if (known.ours == level)
      write(known, program, text);
}

std::atomic<bool>& has_erred() {
  static std::atomic<bool> erred{false};
  return erred;
}

bool set_log_level(const std::string& name) {
  for (const Level& known : kLevels)
    if (known.name == name) {
      logger().set_level(known.theirs);
      return true;
    }
  return false;
}

}  // namespace saphira::bus::internal
