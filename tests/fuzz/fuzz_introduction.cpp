// Packets as a stranger makes them: what the bus reads of them before Fast DDS does.
#include <vector>

#include "fuzz.hpp"
#include "introduction.hpp"
#include "sieve.hpp"

using namespace saphira::bus::internal;

void saphira::fuzz::run(std::string_view text) {
  std::vector<std::uint8_t> message(bytes_of(text), bytes_of(text) + text.size());
  message.resize(sound_length(message.data(), message.size()));
  if (message.empty())
    return;
  const bool introduces = is_announcement(message.data(), message.size()) ||
                          is_handshake(message.data(), message.size());
  if (speaks_for_itself(message.data(), message.size()) && introduces) {
    message[8] ^= 1U;  // the same, sent by another
    require(!speaks_for_itself(message.data(), message.size()));
  }
  announced(message.data(), message.size());
  Sequences sequences;
  sequences.plausible(message.data(), message.size(), {});
}
