#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace saphira {

/// Base64 of RFC 4648, padded. `bytes`: anything of single bytes.
std::string base64(std::string_view bytes);
inline std::string base64(const std::vector<std::uint8_t>& bytes) {
  return base64(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}
/// The bytes; nothing where the text is not base64.
std::optional<std::string> from_base64(std::string_view text);

}  // namespace saphira
