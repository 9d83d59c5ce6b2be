#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/teleop/pilot.hpp"

namespace saphira::teleop {

/// From a joystick or gamepad to orders, with a dead-man: the robot is driven by the first stick
/// while a button is held. That is a shoulder button; the trigger of a joystick without shoulder
/// buttons; the button that is named a dead-man where there is neither. A device without such names
/// does not drive. The device is the kernel's (linux/joystick.h): events of 8 bytes, time [ms],
/// value, type and number. Times are seconds of any steady clock.
class StickDrive {
 public:
  struct Settings {
    double dead_zone = 0.1;     ///< [0..1] of the stick's way
    double silence = 5.0;       ///< [s] a joystick silent for this long may be out of reach
    double max_velocity = 0.4;  ///< [m/s] at full deflection
    double max_turn = 1.0;      ///< [rad/s] likewise
  };
  /// The codes of the device's axes and buttons (linux/input-event-codes.h), in their order.
  /// Nothing drives before.
  void set_layout(const std::vector<std::uint8_t>& axes, const std::vector<std::uint16_t>& buttons);
  /// The button to hold, for people, with its number from 0: "a shoulder button (4 or 5)". Empty:
  /// the kernel names no such button, or no first stick, and the device does not drive.
  const std::string& dead_man() const { return dead_man_; }
  void set_max_velocity(double limit) { settings_.max_velocity = limit; }
  /// Bytes of the device, which may end within an event. A button that was held when the device was
  /// opened counts after a new press.
  void take(std::string_view bytes, double now);
  /// A held button has to be pressed again.
  void let_go() { held_.clear(); }
  /// The device is gone: nothing is held.
  void lost();
  Order order(double now) const;
  /// A button is held and the device is silent: the button has to be let go.
  bool is_silent(double now) const;

 private:
  double share(double axis) const;

  Settings settings_;
  std::string rest_;
  std::string dead_man_;
  std::set<unsigned> holding_;  ///< numbers of the buttons that count
  unsigned across_ = 0;         ///< number of the axis to the right
  unsigned along_ = 0;          ///< number of the axis to the person
  double ahead_ = 0.0;          ///< [-1..1]
  double left_ = 0.0;           ///< [-1..1]
  std::set<unsigned> held_;     ///< buttons of holding_
  double heard_ = -1e9;
};

}  // namespace saphira::teleop
