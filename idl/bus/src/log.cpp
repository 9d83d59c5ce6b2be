#include "log.hpp"

#include <poll.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>

namespace saphira::bus::internal {
namespace {

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    auto made = std::make_shared<spdlog::logger>("saphira",
                                                 std::make_shared<spdlog::sinks::stderr_sink_mt>());
    made->set_pattern("%H:%M:%S.%e %l %v");
    made->flush_on(spdlog::level::debug);
    return made;
  }();
  return *instance;
}

/// False while stderr would block: the terminal may be stopped, or the pipe unread, and a program
/// that holds a robot must not wait. A pipe that can be written to takes a line at once.
bool can_write() {
  pollfd ready{STDERR_FILENO, POLLOUT, 0};
  return ::poll(&ready, 1, 0) == 1 && (ready.revents & POLLOUT) != 0;
}

std::atomic<std::uint64_t> unwritten{0};

}  // namespace

void write_log(v1::LogLevel level, const std::string& text) {
  if (!can_write()) {
    ++unwritten;
    return;
  }
  if (const std::uint64_t lines = unwritten.exchange(0); lines > 0)
    logger().warn("{} lines are missing here: nobody read on", lines);
  switch (level) {
    case v1::LOG_DEBUG:
      logger().log(spdlog::level::debug, text);
      break;
    case v1::LOG_INFO:
      logger().log(spdlog::level::info, text);
      break;
    case v1::LOG_WARNING:
      logger().log(spdlog::level::warn, text);
      break;
    case v1::LOG_ERROR:
      logger().log(spdlog::level::err, text);
      break;
  }
}

bool set_log_level(const std::string& name) {
  if (name == "debug")
    logger().set_level(spdlog::level::debug);
  else if (name == "info")
    logger().set_level(spdlog::level::info);
  else if (name == "warning")
    logger().set_level(spdlog::level::warn);
  else if (name == "error")
    logger().set_level(spdlog::level::err);
  else
    return false;
  return true;
}

}  // namespace saphira::bus::internal
