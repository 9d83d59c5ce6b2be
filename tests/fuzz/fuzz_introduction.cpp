// Packets as a stranger makes them: what the bus reads of them before Fast DDS does.
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "introduction.hpp"
#include "sieve.hpp"

using namespace saphira::bus::internal;

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> message(data, data + size);
  message.resize(sound_length(data, size));
  if (message.empty())
    return 0;
  const bool introduces = is_announcement(message.data(), message.size()) ||
                          is_handshake(message.data(), message.size());
  if (speaks_for_itself(message.data(), message.size()) && introduces) {
    message[8] ^= 1U;  // the same, sent by another
    if (speaks_for_itself(message.data(), message.size()))
      std::abort();
  }
  announced(message.data(), message.size());
  Sequences sequences;
  sequences.plausible(message.data(), message.size(), {});
  return 0;
}
