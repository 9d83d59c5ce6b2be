#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saphira/protocol/command.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/requests/request.hpp"

// Requests to the robot's devices. SI units, but where a number is the robot's own.
namespace saphira::reflector {

enum class Device { servo, gripper, output, analog, timer, sonar, sound, server, serial, vision };

/// The sign that a request was heard. `packet`: one of the type of the wish's value comes.
enum class Proof { once, thrice, output, servo, origin, motors, sonar, analog, packet };

/// The meaning of a request for a robot.
struct Wish {
  std::string text{};                         ///< in words, such as "servo 1500 us"
  std::string refusal{};                      ///< why this robot cannot; empty: it can
  std::vector<protocol::Command> commands{};  ///< none where it cannot
  Proof proof = Proof::once;
  int value = 0;  ///< the expected value
  int mask = 0;
  Device device = Device::servo;
  int setting = 0;  ///< of the device: each is asked for, and shown, by itself
};

/// The requests that a device takes.
const std::vector<Functor>& functors(Device device);
/// The wish of a request that one of functors() can take. digital_output: as the robot shows it.
/// std::invalid_argument says what combination of arguments was expected.
Wish wish_of(const Request& request, const protocol::RobotParameters& parameters,
             std::uint8_t digital_output);

}  // namespace saphira::reflector
