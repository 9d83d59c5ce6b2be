#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>

namespace saphira {

/// std::printf's text.
template <class... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 256> text{};
  const int size = std::snprintf(text.data(), text.size(), pattern, values...);
  if (size < static_cast<int>(text.size()))
    return text.data();
  std::string whole(static_cast<std::size_t>(size), '\0');
  std::snprintf(whole.data(), whole.size() + 1, pattern, values...);
  return whole;
}

/// Two digits a byte.
std::string hex_text(std::span<const std::uint8_t> bytes);

/// As many random bytes of the system, as hex_text. std::runtime_error where it has none.
std::string random_hex(std::size_t bytes);

/// A time [s since 1970], of UTC or of this machine. pattern: std::strftime's, for at most 63
/// characters.
std::string utc_text(std::int64_t seconds, const char* pattern);
std::string local_text(std::int64_t seconds, const char* pattern);

}  // namespace saphira
