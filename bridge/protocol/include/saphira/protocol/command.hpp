#pragma once

#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/protocol/packet.hpp"

namespace saphira::protocol {

struct RobotParameters;

// ---- The client's commands to the robot server: manual Table 5-4. SI units and radians here; this
// file alone converts to and from the packet's millimetres and degrees.

/// The command's number, the first byte of its body; rules() has more of them than need a name
/// here. Those of the manual's Table 5-4 (0-3, 7, 11-13, 21, 30-33, 41, 64) keep its names; the
/// others are from later servers (P2OS, AROS, ARCOS) and from simulators. A number with two
/// meanings has the robots' meaning here: 62 ended the old simulator and asks a robot for its
/// battery.
enum class Number : std::uint8_t {
  kPulse = 0,
  kOpen = 1,
  kClose = 2,
  kPolling = 3,
  kEnable = 4,
  kAcceleration = 5,
  kMaxVelocity = 6,
  kSetOrigin = 7,
  kMove = 8,
  kRotate = 9,
  kMaxRotationVelocity = 10,
  kVelocity = 11,
  kHeading = 12,
  kDeltaHeading = 13,
  kSay = 15,
  kJoystickRequest = 17,
  kConfigRequest = 18,
  kEncoderRequest = 19,
  kRotationVelocity = 21,
  kDeltaSetpoint = 22,
  kRotationAcceleration = 23,
  kSonar = 28,
  kStop = 29,
  kDigitalOutput = 30,
  kTimer = 31,
  kWheelVelocities = 32,
  kGripper = 33,
  kAnalogSelect = 35,
  kGripperValue = 36,
  kGripperRequest = 37,
  kIoRequest = 40,
  kPtu = 41,
  kAux1Send = 42,
  kAux1Read = 43,
  kBumpStall = 44,
  kHostBaud = 50,
  kVision = 53,  ///< our choice: the manual names VISION_COM without its number
  kEmergencyStop = 55,
  kEmergencyStop2 = 57,
  kGyroRequest = 58,
  kAux3Send = 60,
  kAux3Read = 61,
  kBatteryRequest = 62,
  kStep = 64,
  kAux2Send = 66,
  kAux2Read = 67,
  kTrueHeading = 68,
  kTrueOrigin = 69,
  kSound = 90,
  kLateralVelocity = 110,
  kTruePose = 224,
  kSimReset = 225,
  kSimControl = 236,
  kSimStatus = 237,
  kSimMessage = 238,
  kBatteryTest = 250,
  kReset = 253,
  kMaintenance = 255,
};

/// sfCOMPOLLING: the firing sequence of the sonars, repeated; empty switches all off. At most 12
/// (manual 5.6); encode() sends the first twelve.
struct Polling {
  std::vector<std::uint8_t> sonars;  ///< from 0; the packet carries 1 + number
  bool operator==(const Polling&) const = default;
};
/// The unit of a quantity in its packet.
enum class PacketUnit { kMilli, kDegree };  ///< thousandths of the SI unit; degrees
/// A command of a quantity, which is sent in whole units of the packet. Where `low` is 0 its size
/// alone counts.
template <Number N, PacketUnit unit, int low, int high>
struct Quantity {
  static constexpr Number kNumber = N;
  static Quantity of_packet(int whole) {
    whole = low == 0 ? std::abs(whole) : whole;
    return {unit == PacketUnit::kMilli ? whole / 1000.0 : radians(whole)};
  }
  double value = 0.0;
  bool operator==(const Quantity&) const = default;
};
template <Number N, int low = -32767, int high = 32767>
using Milli = Quantity<N, PacketUnit::kMilli, low, high>;
template <Number N, int low = -32767, int high = 32767>
using Degrees = Quantity<N, PacketUnit::kDegree, low, high>;

/// sfCOMVEL [m/s] forward positive.
using Velocity = Milli<Number::kVelocity>;
/// sfCOMDHEAD [rad]: turn by, left positive.
using DeltaHeading = Degrees<Number::kDeltaHeading, -255, 255>;
/// sfCOMRVEL [rad/s] left positive.
using RotationVelocity = Degrees<Number::kRotationVelocity, -255, 255>;
/// sfCOMHEAD: turn to a heading of the server's own coordinates. Sent in whole degrees, 0 to 359.
struct Heading {
  double heading = 0.0;  ///< [rad]
  bool operator==(const Heading&) const = default;
};
/// sfCOMVEL2: both wheels independently. Sent in units of Vel2Divisor, at most +-127 of them.
struct WheelVelocities {
  double left = 0.0;   ///< [m/s]
  double right = 0.0;  ///< [m/s]
  bool operator==(const WheelVelocities&) const = default;
};
/// sfCOMDIGOUT. Servers since P2OS change only the bits that the mask (the argument's high byte)
/// has; PSOS has no mask and sets all.
struct DigitalOutput {
  std::uint8_t bits = 0;
  std::uint8_t mask = 0;
  bool operator==(const DigitalOutput&) const = default;
};
/// sfCOMTIMER: starts the user input timer, which the pin stops.
struct Timer {
  std::uint8_t pin = 0;  ///< 0..7
  bool operator==(const Timer&) const = default;
};
/// sfCOMGRIPPER: 0, 1, 4 or 5; their effect depends on the robot. Servers since P2OS: see
/// GripperAction.
struct Gripper {
  std::uint16_t state = 0;
  bool operator==(const Gripper&) const = default;
};
/// sfCOMPTUPOS: pulse width of the position servo.
struct Ptu {
  std::uint16_t width = 0;  ///< [us] (Table 6-2; Table 5-4 prints "ms")
  bool operator==(const Ptu&) const = default;
};
// ---- Later servers: P2OS, AROS, ARCOS; and simulators. In these files a "later server".

/// ENABLE: motors on or off.
struct Enable {
  bool on = false;
  bool operator==(const Enable&) const = default;
};
/// SETA [m/s2]: the acceleration of translation, or the deceleration where it is negative.
using Acceleration = Milli<Number::kAcceleration>;
/// SETV [m/s]: the largest velocity of a MOVE and of other motions without their own.
using MaxVelocity = Milli<Number::kMaxVelocity, 0>;
/// MOVE [m]: translate by, forward positive. ARIA limits it to 5 m.
using Move = Milli<Number::kMove>;
/// ROTATE [rad/s] left positive: the later name of RVEL.
using Rotate = Degrees<Number::kRotate>;
/// SETRV [rad/s]: the largest velocity of a turn to a heading.
using MaxRotationVelocity = Degrees<Number::kMaxRotationVelocity, 0>;
/// SETRA [rad/s2]: the acceleration of rotation, or the deceleration where it is negative.
using RotationAcceleration = Degrees<Number::kRotationAcceleration>;
/// DCHEAD [rad]: turn by, counted from the heading that was set last; left positive.
using DeltaSetpoint = Degrees<Number::kDeltaSetpoint>;
/// LATVEL [m/s]: sideways, left positive, for robots that can.
using LateralVelocity = Milli<Number::kLateralVelocity>;
/// SONAR: arrays on or off. Bit 0 of the argument is on; the bits above it choose an array.
struct SonarSwitch {
  bool on = false;
  std::uint8_t array = 0;  ///< from 1; 0: all of them
  bool operator==(const SonarSwitch&) const = default;
};
/// MobileSim's SET_POSE: the true pose; dead reckoning does not change. Whole mm, degrees.
struct TruePose {
  Pose pose_in_world;
  bool operator==(const TruePose&) const = default;
};

/// The meanings of GRIPPER's argument for a later server.
enum class GripperAction : std::uint8_t {
  kOpen = 1,
  kClose = 2,
  kStop = 3,
  kLiftUp = 4,
  kLiftDown = 5,
  kLiftStop = 6,
  kStore = 7,
  kDeploy = 8,
  kHalt = 15,
  kPressure = 16,
  kCarry = 17,
};

// Most commands of the later servers are a number and an argument whose meaning is the robot's.
// They are stored by the form of the argument, and have names of their own: Command(IoRequest{2})
// is Command(Integer{Number::kIoRequest, 2}). rule() gives the argument's unit and range.

/// No argument.
struct Bare {
  Number number = Number::kPulse;
  bool operator==(const Bare&) const = default;
};
struct Integer {
  Number number = Number::kConfigRequest;
  int value = 0;
  bool operator==(const Integer&) const = default;
};
/// Bytes, counted (never NUL-terminated: a NUL may be one of them).
struct Text {
  Number number = Number::kSay;
  Bytes text;
  bool operator==(const Text&) const = default;
};
/// An argument of another form: all bytes behind the number.
struct Raw {
  Number number = Number::kSimControl;
  Bytes argument;
  bool operator==(const Raw&) const = default;
};

template <Number N>
struct BareCommand : Bare {
  BareCommand() : Bare{N} {}
};
template <Number N>
struct IntCommand : Integer {
  explicit IntCommand(int argument = 0) : Integer{N, argument} {}
};
template <Number N>
struct TextCommand : Text {
  explicit TextCommand(Bytes bytes = {}) : Text{N, std::move(bytes)} {}
};

using Pulse = BareCommand<Number::kPulse>;  ///< sfCOMPULSE: shows that the client is alive
using Open = BareCommand<Number::kOpen>;    ///< starts motors, sonars and information packets
using Close = BareCommand<Number::kClose>;  ///< back to the wait state
/// The server's own position becomes (0, 0, 0).
using SetOrigin = BareCommand<Number::kSetOrigin>;
/// The simulator's world moves on by 100 ms and then waits.
using Step = BareCommand<Number::kStep>;
using Stop = BareCommand<Number::kStop>;
using EmergencyStop = BareCommand<Number::kEmergencyStop>;
using SimReset = BareCommand<Number::kSimReset>;

// 0: no more of these packets, 1: one, 2: one with every information packet.
using ConfigRequest = IntCommand<Number::kConfigRequest>;
using EncoderRequest = IntCommand<Number::kEncoderRequest>;
using IoRequest = IntCommand<Number::kIoRequest>;
using BatteryRequest = IntCommand<Number::kBatteryRequest>;

using AnalogSelect = IntCommand<Number::kAnalogSelect>;
using GripperValue = IntCommand<Number::kGripperValue>;
using BumpStall = IntCommand<Number::kBumpStall>;
using Sound = IntCommand<Number::kSound>;

/// SAY: pairs of duration [20 ms] and half-cycle of the tone.
using Say = TextCommand<Number::kSay>;
using Aux1Send = TextCommand<Number::kAux1Send>;
/// VISION_COM of manual 9.1: "pioneer_X_mode=N" and the line parameters.
using VisionCommand = TextCommand<Number::kVision>;

/// A command that is not in the table, or has an unreadable argument.
struct Unknown {
  std::uint8_t number = 0;
  bool operator==(const Unknown&) const = default;
};

using Command =
    std::variant<Bare, Polling, Velocity, Heading, DeltaHeading, RotationVelocity, WheelVelocities,
                 DigitalOutput, Timer, Gripper, Ptu, Unknown, Enable, Acceleration, MaxVelocity,
                 Move, Rotate, MaxRotationVelocity, RotationAcceleration, DeltaSetpoint,
                 SonarSwitch, LateralVelocity, TruePose, Integer, Text, Raw>;

// ---- The table of the commands.

enum class ArgumentForm : std::uint8_t {
  kNone,      ///< the number alone; an argument is harmless
  kInteger,   ///< 3B or 1B and two bytes
  kOptional,  ///< an integer, which may be missing
  kPair,      ///< 3B and two signed bytes
  kString,    ///< 2B and bytes, NUL-terminated or counted
  kRaw,       ///< a form of its own
};

/// The origin of a command.
enum class Origin : std::uint8_t {
  kManual,     ///< Table 5-4
  kLater,      ///< P2OS, AROS, ARCOS
  kSimulator,  ///< simulators only
};

/// One line of the table.
struct CommandRule {
  Number number;
  std::string_view name;  ///< as the manual and the robots' header files call it
  ArgumentForm form;
  Origin origin;
  int low = 0;  ///< of an integer, in the unit of the packet
  int high = 0;
  std::string_view unit;
};

/// The line of a number, or null.
const CommandRule* rule(std::uint8_t number);
/// All lines, by number.
std::span<const CommandRule> rules();

/// How the string of POLLING is written. The manual's Table 5-3 says NUL-terminated; clients and
/// robots since have used a length byte. decode_command takes both.
enum class StringForm { kNulTerminated, kLengthPrefixed };

/// The unit of wheel velocities without a value in the parameter file: 4 mm/s (Table 5-4).
inline constexpr double kVel2Unit = 0.004;

/// The whole packet (frame included). Values are rounded to the packet's units and clamped to its
/// range; NaN becomes 0. vel2_unit [m/s] is RobotParameters::vel2_unit.
Bytes encode(const Command& command, double vel2_unit = kVel2Unit,
             StringForm form = StringForm::kNulTerminated);

/// The same with this robot's unit and form of strings.
Bytes encode(const Command& command, const RobotParameters& parameters);

/// Reads a packet's body. A missing argument counts as 0 (OPEN, SETO and others are sent with,
/// without, and with an argument type alone); an integer in place of a string, or a string in place
/// of an integer, is Unknown.
Command decode_command(ByteView body, double vel2_unit = kVel2Unit);

// ---- Start of a connection: manual 5.4.1 and 5.4.2.

/// Table 5-7.
struct RobotIdentity {
  std::string name;
  std::string robot_class;
  std::string subclass;
  bool operator==(const RobotIdentity&) const = default;
};
/// In words, from the robot's own strings.
std::string name_of(const RobotIdentity& robot);

/// SYNC0, SYNC1, SYNC2 as the client sends them and as the server echoes the first two. (The same
/// bytes as PULSE, OPEN and CLOSE: the state of the server decides.)
Bytes encode_sync(int number);
/// The server's answer to SYNC2. Strings are cut where the packet would be too long.
Bytes encode_sync2_reply(const RobotIdentity& identity);
/// The number of a synchronization packet's body: 0, 1 or 2; nothing if it is another packet.
std::optional<int> sync_number(ByteView body);
/// The strings of a SYNC2 answer's body; those that are missing are empty (servers before PSOS 4.1
/// send none). Nothing if it is another packet.
std::optional<RobotIdentity> decode_sync2_reply(ByteView body);

}  // namespace saphira::protocol
