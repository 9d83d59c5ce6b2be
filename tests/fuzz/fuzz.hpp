#pragma once

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "saphira/base/text.hpp"

namespace saphira::fuzz {

/// One input of a fuzzer, which each has; a fault ends the program.
void run(std::string_view input);

inline void require(bool holds) {
  if (!holds)
    std::abort();
}

/// The input as bytes.
inline const std::uint8_t* bytes_of(std::string_view input) {
  return reinterpret_cast<const std::uint8_t*>(input.data());
}

/// Reads a file, or gets the error that says where; true where it could be read.
template <class Read>
bool reads(Read&& read) {
  try {
    read();
    return true;
  } catch (const FileError& error) {
    require(error.line() >= 1 && error.column() >= 1);
    return false;
  }
}

}  // namespace saphira::fuzz
