#pragma once

#include <string>
#include <string_view>

namespace saphira {

/// A line of the log of any program, without its line break:
///
///     10:02:03.456 warning bridge: the motors are off
///
/// time: [s] since 1970, shown as the local time of day. level: debug, info, warning or error.
std::string log_line(double time, std::string_view level, std::string_view program,
                     std::string_view text);

}  // namespace saphira
