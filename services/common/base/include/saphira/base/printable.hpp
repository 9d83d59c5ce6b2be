#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace saphira {

/// A text of somebody else (UTF-8) for a terminal or a log: control characters, which would drive
/// the terminal, are question marks. `kept` stay: "\n\t" in a text of several lines.
inline std::string printable(std::string_view text, std::string_view kept = {}) {
  std::string out(text);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto byte = static_cast<unsigned char>(out[i]);
    const bool ascii = byte < 0x20 || byte == 0x7f;
    // U+0080 to U+009F: terminals take them for an escape and a letter.
    const bool latin = byte >= 0x80 && byte < 0xa0 && i > 0 && out[i - 1] == '\xc2';
    if (latin)
      out[i - 1] = '?';
    if ((ascii || latin) && kept.find(out[i]) == std::string_view::npos)
      out[i] = '?';
  }
  return out;
}

}  // namespace saphira
