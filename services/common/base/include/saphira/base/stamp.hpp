#pragma once

#include <cstdint>

namespace saphira {

/// A time: a cycle of one connection of one bridge to one robot (100 ms each). Epoch 0: no
/// connection; cycle 0: before the first information packet.
struct Stamp {
  std::uint64_t epoch = 0;
  std::uint64_t cycle = 0;

  friend bool operator==(const Stamp&, const Stamp&) = default;
};

}  // namespace saphira
