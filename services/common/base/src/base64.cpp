#include "saphira/base/base64.hpp"

#include <algorithm>

namespace saphira {

namespace {

constexpr std::string_view kLetters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

std::string base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = i; k < i + 3; ++k)
      three = three << 8U | (k < bytes.size() ? static_cast<std::uint8_t>(bytes[k]) : 0U);
    const std::size_t letters = std::min<std::size_t>(4, bytes.size() - i + 1);
    for (std::size_t k = 0; k < 4; ++k)
      text += k < letters ? kLetters[three >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::optional<std::string> from_base64(std::string_view text) {
  if (text.size() % 4 != 0)
    return {};
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t digit = kLetters.find(text[i]);
    if (digit == std::string_view::npos && i < text.size() - padding)
      return {};
    value = value << 6U | static_cast<std::uint32_t>(i < text.size() - padding ? digit : 0);
    if (i % 4 == 3)
      for (const unsigned shift : {16U, 8U, 0U})
        bytes += static_cast<char>(value >> shift & 255U);
  }
  bytes.resize(bytes.size() - padding);
  return bytes;
}

}  // namespace saphira
