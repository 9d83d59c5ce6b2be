#include "sieve.hpp"

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <iterator>

#include "submessage.hpp"

namespace saphira::bus::internal {

namespace {

constexpr std::uint8_t kStatistics = 0x80;
constexpr std::uint8_t kAcknack = 0x06;
constexpr std::uint8_t kHeartbeat = 0x07;
constexpr std::uint8_t kGap = 0x08;

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
    std::size_t next = 0;
    if (submessage(packet, size, at, next).size > size - at - kSubmessageHeader)
      return 0;
    at = next;
  }
  return size;
}

bool is_handshake(const std::uint8_t* message, std::size_t size) {
  std::size_t next = 0;
  for (std::size_t at = kHeader; at + kSubmessageHeader <= size; at = next) {
    const Submessage part = submessage(message, size, at, next);
    if (part.has_data() && (part.is_of(kHandshakeWriter) || part.is_for(kHandshakeReader)))
      return true;
  }
  return false;
}

const std::uint8_t* sender_of(const std::uint8_t* message) {
  return message + 8;
}

std::vector<std::uint8_t> farewell(const std::uint8_t* prefix) {
  std::vector<std::uint8_t> message{'R', 'T', 'P', 'S', 2, 2, 1, 0x0f};
  const auto add = [&](std::initializer_list<std::uint8_t> bytes) {
    message.insert(message.end(), bytes);
  };
  const auto add_participant = [&] {
    message.insert(message.end(), prefix, prefix + 12);
    add({0x00, 0x00, 0x01, 0xc1});
  };
  message.insert(message.end(), prefix, prefix + 12);
  // Little-endian, inline QoS, and the key instead of data; to the end of the message.
  add({kData, 0x0b, 0, 0, 0, 0, 16, 0});
  add({0x00, 0x01, 0x00, 0xc7});
  message.insert(message.end(), std::begin(kParticipantWriter), std::end(kParticipantWriter));
  // A number above all that the participant has used: a smaller one would be ignored.
  add({1, 0, 0, 0, 0, 0, 0, 0});
  add({0x70, 0x00, 16, 0});  // the hash of the key
  add_participant();
  add({0x71, 0x00, 4, 0, 0, 0, 0, 3});  // disposed and unregistered
  add({0x01, 0x00, 0, 0});
  add({0x00, 0x03, 0x00, 0x00});  // a list of parameters, little-endian
  add({0x50, 0x00, 16, 0});
  add_participant();
  add({0x01, 0x00, 0, 0});
  const std::size_t size = message.size() - kHeader - kSubmessageHeader;
  message[kHeader + 2] = static_cast<std::uint8_t>(size);
  return message;
}

bool is_announcement(const std::uint8_t* message, std::size_t size) {
  std::size_t next = 0;
  for (std::size_t at = kHeader; at + kSubmessageHeader <= size; at = next) {
    const Submessage part = submessage(message, size, at, next);
    if (part.has_data() && part.is_of(kParticipantWriter))
      return true;
  }
  return false;
}

bool Sequences::plausible(const std::uint8_t* message, std::size_t size, Time now) {
  if (now - last_ > kSleep)
    awake_since_ = now;
  last_ = now;
  std::size_t next = 0;
  for (std::size_t at = kHeader; at + kSubmessageHeader <= size; at = next) {
    const Submessage part = submessage(message, size, at, next);
    if (part.id == kInfoSource)
      return true;  // the rest belongs to another, unknown participant
    const bool data = part.id == kData || part.id == kDataFragment;
    // Where the writer's id and the highest number stand, as the standard has it.
    const std::size_t writer = data ? 8 : 4;
    const std::size_t number = part.id == kHeartbeat ? 16 : data ? 12 : 8;
    if (!(data || part.id == kHeartbeat || part.id == kGap || part.id == kAcknack) ||
        part.size < 24)
      continue;
    Key key{};
    std::memcpy(key.data(), message + 8, 12);
    std::memcpy(key.data() + 12, part.data + writer, 4);
    if (part.id == kAcknack)
      std::memcpy(key.data() + 16, part.data, 4);
    if ((part.id == kHeartbeat && part.number(8) > part.number(16) + 1) ||
        !follows(key, part.number(number), now) ||
        (part.id == kGap && !follows(key, part.number(16), now)))
      return false;
  }
  return true;
}

std::uint64_t Sequences::longest_leap(const Known& known, Time now) const {
  if (now - awake_since_ < kWaking)
    return kLongestLeap;
  const double silence = std::chrono::duration<double>(now - known.heard).count();
  const double leap = static_cast<double>(kLeap) + static_cast<double>(kLeapPerSecond) * silence;
  return leap < static_cast<double>(kLongestLeap) ? static_cast<std::uint64_t>(leap) : kLongestLeap;
}

bool Sequences::follows(const Key& key, std::uint64_t number, Time now) {
  if (known_.size() >= kMost)
    known_.clear();
  const auto [found, is_new] = known_.try_emplace(key);
  Known& known = found->second;
  if (number <= known.newest + (is_new ? kBeginning : longest_leap(known, now))) {
    if (number > known.newest)
      known.times = 0;
    known.newest = std::max(known.newest, number);
    known.heard = now;
    return true;
  }
  const bool again =
      number + kLongestLeap >= known.doubtful && number <= known.doubtful + kLongestLeap;
  known.times = again ? known.times + 1 : 1;
  known.doubtful = number;
  if (known.times < 3)
    return false;
  known.times = 0;
  known.newest = number;
  known.heard = now;
  return true;
}

}  // namespace saphira::bus::internal
