#include "folding.hpp"

#include <utf8proc.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

namespace saphira::internal {

std::string without_case(std::string_view text, int options) {
  const auto ascii = [](char c) { return static_cast<unsigned char>(c) < 0x80U; };
  if (!std::all_of(text.begin(), text.end(), ascii)) {
    utf8proc_uint8_t* made = nullptr;
    const utf8proc_ssize_t size = utf8proc_map(
        reinterpret_cast<const utf8proc_uint8_t*>(text.data()), std::ssize(text), &made,
        static_cast<utf8proc_option_t>(UTF8PROC_STABLE | UTF8PROC_CASEFOLD | options));
    const std::unique_ptr<utf8proc_uint8_t, decltype(&std::free)> owner(made, &std::free);
    if (size >= 0)
      return {reinterpret_cast<const char*>(made), static_cast<std::size_t>(size)};
  }
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z')
      c = static_cast<char>(c - 'A' + 'a');
  return out;
}

}  // namespace saphira::internal
