#include "saphira/reflector/sweep.hpp"

#include <cmath>
#include <utility>

#include "saphira/base/cycle.hpp"

namespace saphira::reflector {

namespace {

constexpr std::uint64_t kCycles = 30;  // of a swing
constexpr double kPhase = 2.0 * kPi / kCycles;
// Behaviors set their heading from the present one. Their course is the mean.
constexpr double kNewest = 0.1;
constexpr double kTurn = radians(5.0);  // beyond the swing: the driver turns

}  // namespace

void Sweep::step(std::uint64_t cycle, bool needed, double angle, Setpoints& setpoints) {
  swings_ = swings_ && cycle <= begun_ + kCycles;
  if (!swings_) {
    if (!needed || angle == 0.0)
      return;
    swings_ = true;
    begun_ = cycle_ = cycle - 1;
    angle_ = angle;
    course_in_odom_ = setpoints.heading_in_odom;
  }
  const double rate = angle_ * kPhase / kCycle;
  const double off = norm2_angle(setpoints.heading_in_odom - course_in_odom_);
  swings_ = setpoints.velocity != 0.0 &&
            (setpoints.turn_to_heading ? std::abs(off) <= angle_ + kTurn
                                       : std::abs(setpoints.rotation_velocity) <= rate);
  if (!swings_)
    return;
  if (std::exchange(cycle_, cycle) != cycle)
    course_in_odom_ = norm2_angle(course_in_odom_ + kNewest * off);
  const double phase = kPhase * static_cast<double>(cycle - begun_);
  if (setpoints.turn_to_heading)
    setpoints.heading_in_odom = norm2_angle(course_in_odom_ + angle_ * std::sin(phase));
  else
    setpoints.rotation_velocity += rate * std::cos(phase);
}

}  // namespace saphira::reflector
