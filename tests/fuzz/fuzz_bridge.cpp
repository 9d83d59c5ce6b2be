// The bridge: packets, motor commands, emergency stops, silences and gaps, in any order. The rules
// are those of bridge/core/test/play.hpp: no command moves the robot without a live command of a
// driver, zero setpoints come first, an emergency stop wins, packets are whole.

#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "play.hpp"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto played = saphira::bridge::test::play({data, size});
  if (!played.wrong.empty()) {
    std::fprintf(stderr, "%s\n", played.wrong.c_str());
    std::abort();
  }
  return 0;
}
