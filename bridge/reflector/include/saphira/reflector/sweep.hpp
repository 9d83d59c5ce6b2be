#pragma once

#include <cstdint>

#include "saphira/base/archived.hpp"
#include "saphira/reflector/motion.hpp"

namespace saphira::reflector {

/// Swings a driving robot to and fro about its driver's course, so that its sonars cover the gaps
/// between their beams. A swing takes three seconds and ends where it began.
class Sweep {
 public:
  /// Changes the driver's setpoints of this cycle while a swing goes on. `needed` begins a swing of
  /// `angle` [rad] to either side. A stop or a turn of the driver ends it.
  void step(std::uint64_t cycle, bool needed, double angle, Setpoints& setpoints);

  SAPHIRA_ARCHIVE(swings_, begun_, cycle_, angle_, course_in_odom_)

 private:
  bool swings_ = false;
  std::uint64_t begun_ = 0;  ///< the cycle before the first of the swing
  std::uint64_t cycle_ = 0;  ///< of the last step
  double angle_ = 0.0;
  double course_in_odom_ = 0.0;  ///< [rad] of a driver who sets headings
};

}  // namespace saphira::reflector
