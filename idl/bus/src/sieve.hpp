#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "saphira/base/boot_clock.hpp"

namespace saphira::bus::internal {

/// How much of a received packet is an RTPS message that holds together: a header and submessages
/// of which each ends within the packet. 0: nothing.
///
/// Fast DDS's own statistics, which it appends to each message, are cut off: it ends the process
/// (an assertion) where they are not quite as it writes them, and nobody here reads them.
std::size_t sound_length(const std::uint8_t* packet, std::size_t size);

/// True where a sound message says that a participant is there.
bool is_announcement(const std::uint8_t* message, std::size_t size);

/// The GUID prefix of the participant for which a sound message is, where it is part of a handshake
/// of two participants; nullptr of any other message. Each is sent to all, and is for one.
const std::uint8_t* handshake_for(const std::uint8_t* message, std::size_t size);

/// The GUID prefix of the participant that a sound message says it is of.
const std::uint8_t* sender_of(const std::uint8_t* message);

/// True where a sound message says that a participant has ended, or speaks for another than its
/// sender. Both are in clear also where all else is encrypted, so that anybody can say so of
/// anybody.
bool is_forgeable(const std::uint8_t* message, std::size_t size);

/// A message by which a participant says that it has ended: what makes Fast DDS, which cannot be
/// told to ignore somebody, forget a participant and its keys.
std::vector<std::uint8_t> farewell(const std::uint8_t* prefix);

/// The numbers that writers give their samples, and readers acknowledge. Fast DDS believes each:
/// one that is far too high makes it count up to it for minutes, and a reader deaf to that writer
/// until the writer has counted so far.
class Sequences {
 public:
  using Time = BootClock::time_point;

  /// True where the numbers in a sound message follow what was said before. A leap may be as long
  /// as the silence before it explains. A longer one is believed when it is said three times, and
  /// nothing that follows in between.
  bool plausible(const std::uint8_t* message, std::size_t size, Time now);

  /// The leap that needs no silence, and what each second of silence adds: a wrong number costs a
  /// reader of ten samples a second less than 4 s.
  static constexpr std::uint64_t kLeap = 16;
  static constexpr std::uint64_t kLeapPerSecond = 100;
  /// No silence explains more.
  static constexpr std::uint64_t kLongestLeap = 1024;
  /// So long a silence of all is a sleep of this program. What it finds first when it wakes was
  /// sent when it fell asleep, so for a moment each leap up to the longest is believed.
  static constexpr std::chrono::milliseconds kSleep{500};
  static constexpr std::chrono::seconds kWaking{2};
  /// Up to here a writer's first number is believed at once: Fast DDS counts so far in no time.
  static constexpr std::uint64_t kBeginning = 1U << 20U;

 private:
  /// Of whom it is: the participant, the writer, and of an acknowledgement the reader.
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
  Time last_;  ///< message of anybody
  Time awake_since_;
};

}  // namespace saphira::bus::internal
