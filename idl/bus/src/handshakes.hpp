#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>

#include "saphira/base/boot_clock.hpp"

namespace saphira::bus::internal {

/// Programs that announce themselves and were not let in yet. On a loaded machine a handshake may
/// come to a dead end, where each of the two waits for the other for ever (Fast DDS 2.9). The
/// remedy is to forget the other and find it again. Pure bookkeeping: no DDS, no clock.
class Handshakes {
 public:
  using Program = std::array<std::uint8_t, 12>;
  using Time = BootClock::time_point;

  /// The minimum interval of announcements that count: announcements that queued in a socket while
  /// this program stood still count as one.
  static constexpr std::chrono::milliseconds kApart{200};
  /// This many announcements are a dead end: 8 s. A handshake that loses a tenth of its packets
  /// takes up to 4 s.
  static constexpr int kPatience = 32;

  void begin(const Program& program) { pending_.try_emplace(program); }
  /// The program is let in, or gone.
  void end(const Program& program) { pending_.erase(program); }
  /// True where the program is to be forgotten now.
  bool announced(const Program& program, Time now);

 private:
  struct Pending {
    int announcements = 0;
    Time last;
  };
  std::map<Program, Pending> pending_;
};

}  // namespace saphira::bus::internal
