#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

// Numbers as text; read back by LineReader::number.
namespace saphira {

/// For people: six digits, "0.3", "1e+06".
std::string plain(double value);

/// With all digits: it reads back to the same number.
std::string exact(double value);

/// Without an exponent, and without zeros at the end: decimal(1.5, 3) is "1.5".
std::string decimal(double value, int digits);

/// The number that the whole text is; none where it is not one or T cannot hold it. A "+" or a
/// blank is not part of a number; "inf" and "nan" are numbers of a floating-point T. `base` of
/// integers.
template <class T>
std::optional<T> number_in(std::string_view text, int base = 10) {
  T value{};
  const char* const end = text.data() + text.size();
  std::from_chars_result read{};
  if constexpr (std::is_floating_point_v<T>)
    read = std::from_chars(text.data(), end, value);
  else
    read = std::from_chars(text.data(), end, value, base);
  return read.ec == std::errc() && read.ptr == end ? std::optional(value) : std::nullopt;
}

}  // namespace saphira
