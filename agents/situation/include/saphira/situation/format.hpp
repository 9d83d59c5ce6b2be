#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace saphira::situation {

/// std::snprintf's, cut to 255 characters.
template <class... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

}  // namespace saphira::situation
