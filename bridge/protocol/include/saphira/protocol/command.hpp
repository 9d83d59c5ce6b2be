#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "saphira/protocol/packet.hpp"

namespace saphira::protocol {

// ---- What the client asks of the robot server: manual Table 5-4. SI units and radians here; the
// ---- packet's millimetres and degrees are made and read in this file alone.

/// The command's number, the first byte of its body.
enum class Number : std::uint8_t {
  kPulse = 0,
  kOpen = 1,
  kClose = 2,
  kPolling = 3,
  kSetOrigin = 7,
  kVelocity = 11,
  kHeading = 12,
  kDeltaHeading = 13,
  kRotationVelocity = 21,
  kDigitalOutput = 30,
  kTimer = 31,
  kWheelVelocities = 32,
  kGripper = 33,
  kPtu = 41,
  kStep = 64,
};

/// sfCOMPULSE: says that the client is alive.
struct Pulse {
  bool operator==(const Pulse&) const = default;
};
/// sfCOMOPEN: starts motors, sonars and information packets.
struct Open {
  bool operator==(const Open&) const = default;
};
/// sfCOMCLOSE: back to the wait state.
struct Close {
  bool operator==(const Close&) const = default;
};
/// sfCOMPOLLING: which sonars fire, in this order, over and over; empty switches all off. At most
/// 12 (manual 5.6); encode() sends the first twelve.
struct Polling {
  std::vector<std::uint8_t> sonars;  ///< from 0; the packet carries 1 + number
  bool operator==(const Polling&) const = default;
};
/// sfCOMSETO: the server's own position becomes (0, 0, 0).
struct SetOrigin {
  bool operator==(const SetOrigin&) const = default;
};
/// sfCOMVEL. Sent in whole mm/s.
struct Velocity {
  double velocity = 0.0;  ///< [m/s] forward positive
  bool operator==(const Velocity&) const = default;
};
/// sfCOMHEAD: turn to a heading of the server's own coordinates. Sent in whole degrees, 0 to 359.
struct Heading {
  double heading = 0.0;  ///< [rad]
  bool operator==(const Heading&) const = default;
};
/// sfCOMDHEAD: turn by. Sent in whole degrees, at most 255.
struct DeltaHeading {
  double delta = 0.0;  ///< [rad] left positive
  bool operator==(const DeltaHeading&) const = default;
};
/// sfCOMRVEL. Sent in whole deg/s, at most 255.
struct RotationVelocity {
  double velocity = 0.0;  ///< [rad/s] left positive
  bool operator==(const RotationVelocity&) const = default;
};
/// sfCOMVEL2: both wheels independently. Sent in units of Vel2Divisor, at most +-127 of them.
struct WheelVelocities {
  double left = 0.0;   ///< [m/s]
  double right = 0.0;  ///< [m/s]
  bool operator==(const WheelVelocities&) const = default;
};
/// sfCOMDIGOUT.
struct DigitalOutput {
  std::uint8_t bits = 0;
  bool operator==(const DigitalOutput&) const = default;
};
/// sfCOMTIMER: starts the user input timer, which the pin stops.
struct Timer {
  std::uint8_t pin = 0;  ///< 0..7
  bool operator==(const Timer&) const = default;
};
/// sfCOMGRIPPER: 0, 1, 4 or 5; what they do is the robot's.
struct Gripper {
  std::uint16_t state = 0;
  bool operator==(const Gripper&) const = default;
};
/// sfCOMPTUPOS: pulse width of the position servo.
struct Ptu {
  std::uint16_t width = 0;  ///< [us] (Table 6-2; Table 5-4 prints "ms")
  bool operator==(const Ptu&) const = default;
};
/// sfCOMSTEP: the simulator's world moves on by 100 ms and then waits.
struct Step {
  bool operator==(const Step&) const = default;
};
/// A command that is not in the table, or one whose argument cannot be read.
struct Unknown {
  std::uint8_t number = 0;
  bool operator==(const Unknown&) const = default;
};

using Command = std::variant<Pulse, Open, Close, Polling, SetOrigin, Velocity, Heading,
                             DeltaHeading, RotationVelocity, WheelVelocities, DigitalOutput, Timer,
                             Gripper, Ptu, Step, Unknown>;

/// How a string argument is written. The manual's Table 5-3 says NUL-terminated; clients and robots
/// since have used a length byte. decode_command takes both.
enum class StringForm { kNulTerminated, kLengthPrefixed };

/// The wheel velocities' unit where the parameter file says nothing: 4 mm/s (Table 5-4).
inline constexpr double kVel2Unit = 0.004;

/// The whole packet (frame included). Values are rounded to the packet's units and clamped to what
/// it can say; NaN becomes 0. vel2_unit [m/s] is RobotParameters::vel2_unit.
Bytes encode(const Command& command, double vel2_unit = kVel2Unit,
             StringForm form = StringForm::kNulTerminated);

/// Reads a packet's body. An argument that is missing counts as 0 (OPEN, SETO and others are sent
/// with, without, and with an argument type alone); an integer where a string is needed, or a
/// string where an integer is needed, is Unknown.
Command decode_command(ByteView body, double vel2_unit = kVel2Unit);

// ---- Start of a connection: manual 5.4.1 and 5.4.2.

/// Table 5-7.
struct RobotIdentity {
  std::string name;
  std::string robot_class;
  std::string subclass;
  bool operator==(const RobotIdentity&) const = default;
};

/// SYNC0, SYNC1, SYNC2 as the client sends them and as the server echoes the first two. (The same
/// bytes as PULSE, OPEN and CLOSE: which is meant depends on the state of the server.)
Bytes encode_sync(int number);
/// The server's answer to SYNC2. Strings are cut where the packet would be too long.
Bytes encode_sync2_reply(const RobotIdentity& identity);
/// The number of a synchronization packet's body: 0, 1 or 2; nothing if it is another packet.
std::optional<int> sync_number(ByteView body);
/// The strings of a SYNC2 answer's body; those that are missing are empty (servers before PSOS 4.1
/// send none). Nothing if it is another packet.
std::optional<RobotIdentity> decode_sync2_reply(ByteView body);

}  // namespace saphira::protocol
