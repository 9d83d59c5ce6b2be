#include "saphira/base/log_line.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "saphira/base/printable.hpp"

namespace saphira {

std::string log_line(double time, std::string_view level, std::string_view program,
                     std::string_view text) {
  const double second = std::floor(time);
  const auto seconds = static_cast<std::time_t>(second);
  std::tm local{};
  localtime_r(&seconds, &local);
  std::array<char, 64> clock{};
  std::snprintf(clock.data(), clock.size(), "%02d:%02d:%02d.%03d", local.tm_hour, local.tm_min,
                local.tm_sec, static_cast<int>((time - second) * 1000.0));
  std::string line = clock.data();
  for (const std::string_view part : {level, program})
    line.append(" ").append(printable(part));
  return line.append(": ").append(printable(text, "\n\t"));
}

}  // namespace saphira
