#pragma once

#include <cstdint>

namespace saphira::console {

/// Decides when the robot's state is also sent over an operator's command connections, one cycle by
/// each in turn. A lost packet delays all later ones of its own connection, and none of another.
/// The operator's samples name the cycle on the screen: an old one shows a long or lossy link.
/// Times are seconds of any steady clock.
class Detour {
 public:
  /// A sample of the operator shows this cycle, at that newest one.
  void shows(std::uint64_t cycle, std::uint64_t newest, double now) {
    const std::uint64_t behind = newest > cycle ? newest - cycle : 0;
    cut_ = behind > kCutCycles;
    if (behind >= kOldCycles)
      late_ = now;
  }
  bool wanted(double now) const { return !cut_ && now < late_ + kDetour; }

 private:
  static constexpr std::uint64_t kOldCycles = 4;   ///< there and back
  static constexpr std::uint64_t kCutCycles = 30;  ///< what is sent now would only queue up
  static constexpr double kDetour = 10.0;          ///< [s] after an old cycle

  double late_ = -1e9;  ///< [s] time of the newest sample that showed an old cycle
  bool cut_ = false;    ///< so old that nothing comes through
};

}  // namespace saphira::console
