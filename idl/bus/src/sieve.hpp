#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "saphira/base/boot_clock.hpp"

namespace saphira::bus::internal {

/// The length of the sound part of a received packet: an RTPS header and submessages that each end
/// within the packet. 0: none.
///
/// Fast DDS's own statistics, which it appends to each message, are cut off: they end the process
/// by an assertion where they are malformed, and nobody here reads them.
std::size_t sound_length(const std::uint8_t* packet, std::size_t size);

/// True where a sound message announces a participant.
bool is_announcement(const std::uint8_t* message, std::size_t size);

/// True where a sound message is part of the handshake of two participants.
bool is_handshake(const std::uint8_t* message, std::size_t size);

/// The GUID prefix of the participant that a sound message claims as its sender.
const std::uint8_t* sender_of(const std::uint8_t* message);

/// A message by which a participant says that it has ended. It makes Fast DDS, which cannot ignore
/// a participant, forget the participant and its keys.
std::vector<std::uint8_t> farewell(const std::uint8_t* prefix);

/// The sample numbers of writers, and those that readers acknowledge. Fast DDS believes each
/// number: a number that is far too high makes Fast DDS count up to it for minutes, and makes a
/// reader deaf to that writer until the writer has counted so far.
class Sequences {
 public:
  using Time = BootClock::time_point;

  /// True where the numbers in a sound message follow the earlier ones. A leap may be as long as
  /// the silence before it explains. A longer leap is believed when it comes three times and
  /// nothing in between follows the old numbers.
  bool plausible(const std::uint8_t* message, std::size_t size, Time now);

  /// The leap that needs no silence, and the leap that each second of silence adds: a wrong number
  /// costs a reader of ten samples a second less than 4 s.
  static constexpr std::uint64_t kLeap = 16;
  static constexpr std::uint64_t kLeapPerSecond = 100;
  /// The longest leap that silence explains.
  static constexpr std::uint64_t kLongestLeap = 1024;
  /// A silence of all participants for this long is a sleep of this program. The first packets
  /// after it are from the time before it, so for a moment each leap up to the longest is believed.
  static constexpr std::chrono::milliseconds kSleep{500};
  static constexpr std::chrono::seconds kWaking{2};
  /// A writer's first number up to this one is believed at once: Fast DDS counts up to it quickly.
  static constexpr std::uint64_t kBeginning = 1U << 20U;

 private:
  /// The participant, the writer, and for an acknowledgement the reader.
  using Key = std::array<std::uint8_t, 20>;
  struct Known {
    std::uint64_t newest = 0;
    Time heard;
    std::uint64_t doubtful = 0;
    int times = 0;
  };

  bool follows(const Key& key, std::uint64_t number, Time now);
  std::uint64_t longest_leap(const Known& known, Time now) const;

  static constexpr std::size_t kMost = 20000;
  std::map<Key, Known> known_;
  Time last_;  ///< newest message of any participant
  Time awake_since_;
};

}  // namespace saphira::bus::internal
