// libFuzzer's entry function.
#include "fuzz.hpp"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  saphira::fuzz::run({reinterpret_cast<const char*>(data), size});
  return 0;
}
