#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "saphira/requests/request.hpp"

// Requests to the robot's devices. SI units, but where a number is the robot's own.
namespace saphira::reflector {

struct ServoWish {
  std::uint16_t width = 0;       ///< [us]
  std::optional<double> look{};  ///< [rad] instead, a direction of the head
};
enum class GripperAction {
  open,
  close,
  stop,
  lift_up,
  lift_down,
  lift_stop,
  store,
  deploy,
  halt,
  pressure,
  carry,
  number
};
struct GripperWish {
  GripperAction action = GripperAction::stop;
  std::uint16_t value = 0;  ///< of pressure, carry and number, in the robot's own units
};
struct OutputWish {
  std::uint8_t mask = 0;
  std::uint8_t bits = 0;
};
struct AnalogWish {
  std::uint8_t port = 0;
};
struct TimerWish {
  std::uint8_t pin = 0;
};
struct SonarWish {
  bool on = true;
  std::vector<std::uint8_t> polling;  ///< empty: all, in order
};
struct Tone {
  std::uint8_t duration = 0;  ///< [20 ms]
  std::uint8_t pitch = 0;     ///< the robot's own; 0 is silence
};
struct SoundWish {
  std::vector<Tone> tones;  ///< empty: a stored sound
  std::uint8_t stored = 0;
};
enum class ServerAction { set_origin, motors, bump_stall, configuration, encoders, io, gripper };
struct ServerWish {
  ServerAction action = ServerAction::set_origin;
  int value = 0;
};
struct SerialWish {
  std::uint8_t port = 1;
  std::vector<std::uint8_t> data;
  std::uint8_t answer = 0;
};
struct VisionWish {
  std::string text;  ///< protocol::parse_vision_setting takes it
};
/// In the order of Device.
using Wish = std::variant<ServoWish, GripperWish, OutputWish, AnalogWish, TimerWish, SonarWish,
                          SoundWish, ServerWish, SerialWish, VisionWish>;
enum class Device { servo, gripper, output, analog, timer, sonar, sound, server, serial, vision };

/// A wish in words, such as "servo 1500 us".
std::string text(const Wish& wish);

/// The requests that a device takes.
const std::vector<Functor>& functors(Device device);
/// The wish of a request that one of functors() can take; std::invalid_argument says what
/// combination of arguments was expected.
Wish wish_of(const Request& request);

}  // namespace saphira::reflector
