#pragma once

#include <termios.h>

#include <optional>
#include <utility>

namespace saphira::transport {

inline std::optional<speed_t> speed_of(int baud) {
  constexpr std::pair<int, speed_t> kSpeeds[]{
      {1200, B1200},   {2400, B2400},   {4800, B4800},     {9600, B9600},    {19200, B19200},
      {38400, B38400}, {57600, B57600}, {115200, B115200}, {230400, B230400}};
  for (const auto& [each, speed] : kSpeeds)
    if (each == baud)
      return speed;
  return std::nullopt;
}

}  // namespace saphira::transport
