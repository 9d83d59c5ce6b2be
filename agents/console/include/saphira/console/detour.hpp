#pragma once

#include <cstdint>

namespace saphira::console {

/// Decides when the robot's state goes over an operator's command connections too, one cycle by
/// each in turn. The operator's samples name the cycle on the screen. Where that is old, the link
/// is long, or holds up the telemetry by what was lost on it; another connection is not held up by
/// that. Times are seconds of any steady clock.
class Detour {
 public:
  /// A sample of the operator shows this cycle, at that newest one.
  void shows(std::uint64_t cycle, std::uint64_t newest, double now);
  bool wanted(double now) const;

 private:
  double late_ = -1e9;  ///< [s] time of the newest sample that showed an old cycle
  bool cut_ = false;    ///< so old that nothing comes through
};

}  // namespace saphira::console
