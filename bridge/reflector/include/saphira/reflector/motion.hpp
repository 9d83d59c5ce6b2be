#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "saphira/base/archived.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::reflector {

enum class Translation { none, velocity, position };
enum class Rotation { none, velocity, heading, relative_heading };

/// A driver's setpoints for the two channels (manual 6.4). They are independent.
struct Motion {
  Translation translation = Translation::none;
  double velocity = 0.0;   ///< [m/s] setpoint; the greatest speed of a position [0: robot's own]
  double distance = 0.0;   ///< [m] of a position
  std::uint64_t move = 0;  ///< a new number begins a new position or relative heading
  Rotation rotation = Rotation::none;
  double rotation_velocity = 0.0;  ///< [rad/s]
  double heading = 0.0;            ///< [rad] in odom, or relative
  std::uint64_t driver = 0;        ///< the driver; each counts its own moves
};

/// The robot's ability to move.
struct Limits {
  double max_velocity = 0.4;           ///< [m/s]
  double max_rotation_velocity = 1.7;  ///< [rad/s]
  double deceleration = 0.5;           ///< [m/s2] at a position's end; well under the server's own
};

/// The setpoints of one moment.
struct Setpoints {
  double velocity = 0.0;           ///< [m/s]
  bool turn_to_heading = false;    ///< true: heading counts; false: rotation_velocity
  double heading_in_odom = 0.0;    ///< [rad]
  double rotation_velocity = 0.0;  ///< [rad/s]
  bool operator==(const Setpoints&) const = default;
};

/// Direct motion control: turns a driver's wish into setpoints. The position mode is made here,
/// since no robot of the manual has it: a trapezoid of the speed by the remaining distance.
class DirectMotion {
 public:
  explicit DirectMotion(Limits limits = {}) : limits_(limits) {}
  void configure(Limits limits) { limits_ = limits; }

  /// Both channels to zero. A position or relative heading that was under way is over: the same
  /// `move` of the same driver does not restart it.
  void stop();
  /// The newest wish of the driver.
  void set(const Motion& motion, const Pose& pose_in_odom);
  /// The robot moved by `advance` [m] along its heading.
  void moved(double advance) { travelled_ += advance; }

  Setpoints setpoints() const;
  /// [m] The remaining way of a position; 0: done, or no position.
  double distance_left() const;

  SAPHIRA_ARCHIVE(limits_, setpoints_, target_, speed_, travelled_, begun_, sets_)

 private:
  Limits limits_;
  Setpoints setpoints_;
  std::optional<double> target_;  ///< [m] on the scale of travelled_
  double speed_ = 0.0;            ///< [m/s] the greatest of a position
  double travelled_ = 0.0;
  struct Begun {
    std::uint64_t move = 0;
    std::uint64_t used = 0;  ///< the number of that set()
  };
  std::map<std::uint64_t, Begun> begun_;  ///< each driver's newest move
  std::uint64_t sets_ = 0;
};

}  // namespace saphira::reflector
