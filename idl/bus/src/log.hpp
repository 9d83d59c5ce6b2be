#pragma once

#include <string>

#include "system.h"

namespace saphira::bus::internal {

/// To stderr, at once.
void write_log(v1::LogLevel level, const std::string& text);
/// debug, info, warning or error; what is below it is not written. False where it is none of them.
bool set_log_level(const std::string& name);

}  // namespace saphira::bus::internal
