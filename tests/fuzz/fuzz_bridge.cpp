// The bridge: packets, motor commands, emergency stops, silences and gaps, in any order. The rules
// are those of bridge/core/test/play.hpp: no command moves the robot without a live command of a
// driver, zero setpoints come first, an emergency stop wins, packets are whole.

#include <cstdio>

#include "fuzz.hpp"
#include "play.hpp"

void saphira::fuzz::run(std::string_view text) {
  const auto played = saphira::bridge::test::play({bytes_of(text), text.size()});
  if (!played.wrong.empty()) {
    std::fprintf(stderr, "%s\n", played.wrong.c_str());
    std::abort();
  }
}
