#pragma once

#include <string>
#include <string_view>

namespace saphira::cli {

/// From a joystick to setpoints, with a dead-man: the robot is driven while a shoulder button (4 to
/// 7) is held, by the first stick. The joystick is the kernel's (linux/joystick.h): events of 8
/// bytes, time [ms], value, type and number. Times are seconds of any steady clock.
class StickDrive {
 public:
  struct Settings {
    double dead_zone = 0.1;     ///< [0..1] of the stick's way
    double silence = 5.0;       ///< [s] a joystick that says nothing so long may be out of reach
    double max_velocity = 0.4;  ///< [m/s] of a stick that is pushed all the way
    double max_turn = 1.0;      ///< [rad/s] likewise
  };
  struct Setpoint {
    bool active = false;    ///< the dead-man is held
    double velocity = 0.0;  ///< [m/s]
    double turn = 0.0;      ///< [rad/s] counter-clockwise
  };

  void set_max_velocity(double limit) { settings_.max_velocity = limit; }
  /// Bytes of the device, which may end within an event. A button that is held when the device is
  /// opened counts when it is pressed again.
  void take(std::string_view bytes, double now);
  /// A button that is held has to be pressed again.
  void let_go() { held_ = 0; }
  /// The device is gone: nothing is held.
  void lost();
  Setpoint setpoint(double now) const;
  /// It is held and says nothing any more: it has to be let go.
  bool is_silent(double now) const;

 private:
  double share(double axis) const;

  Settings settings_;
  std::string rest_;
  double ahead_ = 0.0;  ///< [-1..1]
  double left_ = 0.0;   ///< [-1..1]
  unsigned held_ = 0;   ///< shoulder buttons, a bit each
  double heard_ = -1e9;
};

}  // namespace saphira::cli
