#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>

namespace saphira::bus::internal {

/// How much of a received packet is an RTPS message that holds together: a header and submessages
/// of which each ends within the packet. 0: nothing.
///
/// Fast DDS's own statistics, which it appends to each message, are cut off: it ends the process
/// (an assertion) where they are not quite as it writes them, and nobody here reads them.
std::size_t sound_length(const std::uint8_t* packet, std::size_t size);

/// The numbers that writers give their samples, and readers acknowledge. Fast DDS believes each:
/// one that is far too high makes it count up to it for minutes, or deaf to a writer for good.
class Sequences {
 public:
  /// Whether the numbers in a sound message follow what was said before. One that leaps by more
  /// than kLeap is believed when it is said three times: somebody may have been away for long.
  bool plausible(const std::uint8_t* message, std::size_t size);

  static constexpr std::uint64_t kLeap = 1024;
  /// Up to here a writer's first number is believed at once: Fast DDS counts so far in no time.
  static constexpr std::uint64_t kBeginning = 1U << 20U;

 private:
  /// Of whom it is: the participant, the writer, and of an acknowledgement the reader.
  using Key = std::array<std::uint8_t, 20>;
  struct Known {
    std::uint64_t newest = 0;
    std::uint64_t doubtful = 0;
    int times = 0;
  };

  bool follows(const Key& key, std::uint64_t number);

  static constexpr std::size_t kMost = 20000;
  std::map<Key, Known> known_;
};

}  // namespace saphira::bus::internal
