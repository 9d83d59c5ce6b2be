#include "saphira/base/format.hpp"

#include <sys/random.h>

#include <ctime>
#include <stdexcept>
#include <vector>

namespace saphira {

namespace {

std::string time_text(std::int64_t seconds, const char* pattern,
                      std::tm* (*parts_of)(const std::time_t*, std::tm*)) {
  const std::time_t time = seconds;
  std::tm parts{};
  std::array<char, 64> text{};
  if (parts_of(&time, &parts) != nullptr)
    std::strftime(text.data(), text.size(), pattern, &parts);
  return text.data();
}

}  // namespace

std::string hex_text(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes)
    for (const int half : {byte >> 4, byte & 15})
      text += "0123456789abcdef"[half];
  return text;
}

std::string random_hex(std::size_t bytes) {
  std::vector<std::uint8_t> random(bytes);
  if (getrandom(random.data(), bytes, 0) != static_cast<ssize_t>(bytes))
    throw std::runtime_error("the system has no random numbers");
  return hex_text(random);
}

std::string utc_text(std::int64_t seconds, const char* pattern) {
  return time_text(seconds, pattern, gmtime_r);
}

std::string local_text(std::int64_t seconds, const char* pattern) {
  return time_text(seconds, pattern, localtime_r);
}

}  // namespace saphira
