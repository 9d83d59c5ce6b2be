#pragma once

// The parts of an RTPS message, for those who read it before Fast DDS does.

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace saphira::bus::internal {

constexpr std::size_t kHeader = 20;
constexpr std::size_t kSubmessageHeader = 4;
constexpr std::uint8_t kPad = 0x01;
constexpr std::uint8_t kInfoTimestamp = 0x09;
constexpr std::uint8_t kInfoSource = 0x0c;
constexpr std::uint8_t kData = 0x15;
constexpr std::uint8_t kDataFragment = 0x16;
// Flags of data.
constexpr std::uint8_t kInlineQos = 0x02;
constexpr std::uint8_t kPayload = 0x04;
constexpr std::uint8_t kKey = 0x08;
/// Announces participants.
constexpr std::uint8_t kParticipantWriter[] = {0x00, 0x01, 0x00, 0xc2};
constexpr std::uint8_t kHandshakeWriter[] = {0x00, 0x02, 0x01, 0xc3};
constexpr std::uint8_t kHandshakeReader[] = {0x00, 0x02, 0x01, 0xc4};

/// A submessage of a sound message.
struct Submessage {
  std::uint8_t id;
  bool little;
  const std::uint8_t* data;  // behind its header
  std::size_t size;

  std::uint8_t flags() const { return data[-3]; }
  /// Data or a fragment of data: its reader and writer.
  bool has_data() const { return (id == kData || id == kDataFragment) && size >= 20; }
  bool is_for(const std::uint8_t* reader) const { return std::memcmp(data + 4, reader, 4) == 0; }
  bool is_of(const std::uint8_t* writer) const { return std::memcmp(data + 8, writer, 4) == 0; }
  std::uint64_t word(std::size_t at) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value = value << 8U | data[at + (little ? 3 - i : i)];
    return value;
  }
  std::size_t half(std::size_t at) const {
    return little ? data[at] | std::size_t{data[at + 1]} << 8U
                  : data[at + 1] | std::size_t{data[at]} << 8U;
  }
  /// A sequence number: its high word first.
  std::uint64_t number(std::size_t at) const { return word(at) << 32U | word(at + 4); }
};

/// The submessage that begins there; `next` is where its successor begins.
inline Submessage submessage(const std::uint8_t* message, std::size_t size, std::size_t at,
                             std::size_t& next) {
  Submessage result{message[at], (message[at + 1] & 1U) != 0, message + at + kSubmessageHeader, 0};
  const std::size_t one = message[at + 2];
  const std::size_t other = message[at + 3];
  result.size = result.little ? one | other << 8U : one << 8U | other;
  // The last one may leave its length open.
  if (result.size == 0 && result.id != kPad && result.id != kInfoTimestamp)
    result.size = size - at - kSubmessageHeader;
  next = at + kSubmessageHeader + ((result.size + 3) & ~std::size_t{3});
  return result;
}

}  // namespace saphira::bus::internal
