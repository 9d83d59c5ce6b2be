#pragma once

#include <atomic>
#include <string>

#include "saphira/idl/system.hpp"

namespace saphira::bus::internal {

/// To stderr, at once, as a log_line of that program.
void write_log(v1::LogLevel level, const std::string& program, const std::string& text);
/// True after an error was logged.
std::atomic<bool>& has_erred();
/// debug, info, warning or error; lower levels are not written. False for any other name.
bool set_log_level(const std::string& name);

}  // namespace saphira::bus::internal
