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
    double silence = 5.0;       ///< [s] a joystick silent for this long may be out of reach
    double max_velocity = 0.4;  ///< [m/s] at full deflection
    double max_turn = 1.0;      ///< [rad/s] likewise
  };
  struct Setpoint {
    bool active = false;    ///< the dead-man is held
    double velocity = 0.0;  ///< [m/s]
    double turn = 0.0;      ///< [rad/s] counter-clockwise
  };

  void set_max_velocity(double limit) { settings_.max_velocity = limit; }
  /// Bytes of the device, which may end within an event. A button that was held when the device was
  /// opened counts after a new press.
  void take(std::string_view bytes, double now);
  /// A held button has to be pressed again.
  void let_go() { held_ = 0; }
  /// The device is gone: nothing is held.
  void lost();
  Setpoint setpoint(double now) const;
  /// A button is held and the device is silent: the button has to be let go.
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
