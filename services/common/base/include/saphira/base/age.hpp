#pragma once

#include <cmath>
#include <limits>

#include "saphira/base/archived.hpp"

/// The robot's speed limit from the age of its inputs. An input is of use for as long as the robot
/// cannot have moved further than a stated distance since: the older the input, the slower the
/// robot.
namespace saphira {

/// [m] That distance: a quarter of the 0.6 m ahead that behaviors steer by. A robot that steers by
/// a point L ahead with a delay T begins to swing around its course at v T / L = 0.25.
inline constexpr double kUnseenWay = 0.15;
/// [m/s] Slower is not worth driving.
inline constexpr double kCreep = 0.05;
/// [s] Older inputs do not drive the robot at all.
inline constexpr double kOldest = kUnseenWay / kCreep;

/// [m/s] The speed at which the robot moves kUnseenWay within `age` [s]; infinity at age 0, 0
/// beyond kOldest.
inline double speed_for_age(double age) {
  if (age <= 0.0)
    return std::numeric_limits<double>::infinity();
  return age > kOldest ? 0.0 : kUnseenWay / age;
}

/// [m/s] The speed v from which the robot stops within `free` [m], when it begins to brake after
/// `reaction` [s]: v t + v^2 / 2a = free.
inline double speed_that_stops(double free, double reaction, double deceleration) {
  if (free <= 0.0)
    return 0.0;
  const double way = deceleration * reaction;
  return std::sqrt(way * way + 2.0 * deceleration * free) - way;
}

/// The recent peaks of an age with jitter and loss.
class PeakAge {
 public:
  /// The peak, one cycle later, with this new age [s].
  double hear(double age) {
    peak_ = std::fmax(age, age + kFading * (peak_ - age));
    return peak_;
  }
  double peak() const { return peak_; }

  SAPHIRA_ARCHIVE(peak_)

 private:
  // Per cycle: a peak halves in 2.3 s.
  static constexpr double kFading = 0.97;

  double peak_ = 0.0;
};

}  // namespace saphira
