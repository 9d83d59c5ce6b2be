#include "sieve.hpp"

#include <cstring>

namespace saphira::bus::internal {

namespace {

constexpr std::size_t kHeader = 20;
constexpr std::size_t kSubmessageHeader = 4;
constexpr std::uint8_t kPad = 0x01;
constexpr std::uint8_t kInfoTimestamp = 0x09;
constexpr std::uint8_t kStatistics = 0x80;

}  // namespace

std::size_t sound_length(const std::uint8_t* packet, std::size_t size) {
  if (size < kHeader + kSubmessageHeader || std::memcmp(packet, "RTPS", 4) != 0)
    return 0;
  std::size_t at = kHeader;
  while (at < size) {
    if (size - at < kSubmessageHeader)
      return 0;
    const std::uint8_t id = packet[at];
    if (id == kStatistics)
      return at == kHeader ? 0 : at;
    const bool little = (packet[at + 1] & 1U) != 0;
    const std::size_t one = packet[at + 2];
    const std::size_t other = packet[at + 3];
    const std::size_t length = little ? one | other << 8U : one << 8U | other;
    // The last one may leave its length open.
    if (length == 0 && id != kPad && id != kInfoTimestamp)
      return size;
    if (length > size - at - kSubmessageHeader)
      return 0;
    at += kSubmessageHeader + ((length + 3) & ~std::size_t{3});
  }
  return size;
}

}  // namespace saphira::bus::internal
