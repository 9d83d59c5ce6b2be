#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace saphira {

/// A hash of bytes that is the same on every machine and in every run: FNV-1a of 64 bits (Fowler,
/// Noll and Vo). It protects against accidents, not against people.
class Fnv1a {
 public:
  void add(std::uint8_t byte) { value_ = (value_ ^ byte) * 0x100000001b3U; }
  void add(std::string_view text) {
    for (const char c : text)
      add(static_cast<std::uint8_t>(c));
  }
  std::uint64_t value() const { return value_; }
  /// The value as 16 hexadecimal digits.
  std::string text() const {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(value_));
    return digits;
  }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace saphira
