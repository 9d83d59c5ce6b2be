#include "saphira/protocol/command.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "fields.hpp"
#include "saphira/base/overloaded.hpp"
#include "saphira/protocol/parameters.hpp"

namespace saphira::protocol {

namespace {

// Manual Table 5-3.
constexpr std::uint8_t kArgInt = 0x3B;
constexpr std::uint8_t kArgNegativeInt = 0x1B;
constexpr std::uint8_t kArgString = 0x2B;
constexpr std::size_t kMaxPolling = 12;

int rounded(double value, int low, int high) {
  if (std::isnan(value))
    return 0;
  return static_cast<int>(
      std::lround(std::clamp(value, static_cast<double>(low), static_cast<double>(high))));
}

Bytes bare(Number number) {
  const Bytes body{static_cast<std::uint8_t>(number)};
  return frame(body);
}

// Negative integers travel as their absolute value with a type of their own.
Bytes with_int(Number number, int value) {
  const unsigned size = static_cast<unsigned>(std::abs(value));
  const Bytes body{static_cast<std::uint8_t>(number), value < 0 ? kArgNegativeInt : kArgInt,
                   static_cast<std::uint8_t>(size & 0xFFU),
                   static_cast<std::uint8_t>(size >> 8U & 0xFFU)};
  return frame(body);
}

Bytes with_string(Number number, const Bytes& text, StringForm form) {
  Bytes body{static_cast<std::uint8_t>(number), kArgString};
  if (form == StringForm::kLengthPrefixed)
    body.push_back(static_cast<std::uint8_t>(text.size()));
  body.insert(body.end(), text.begin(), text.end());
  if (form == StringForm::kNulTerminated)
    body.push_back(0);
  return frame(body);
}

// The argument of a command, as far as it is complete.
struct Argument {
  enum class Kind { kNone, kInt, kString, kBroken } kind = Kind::kNone;
  int value = 0;
  Bytes text;
};

// A counted string may end in a NUL, and a NUL-terminated one may begin with its own count. The
// habits of the command's clients decide.
Argument read_argument(ByteView body, bool counted) {
  if (body.size() <= 2)
    return {};
  const ByteView data = body.subspan(2);
  switch (body[1]) {
    case kArgInt:
    case kArgNegativeInt: {
      if (data.size() < 2)
        return {Argument::Kind::kBroken, 0, {}};
      const int size = data[0] | data[1] << 8;
      // A positive type whose value does not fit a signed word is a negative number in two's
      // complement, as some clients send it.
      if (body[1] == kArgInt)
        return {Argument::Kind::kInt, size > 0x7FFF ? size - 0x10000 : size, {}};
      return {Argument::Kind::kInt, size > 0x7FFF ? size - 0x10000 : -size, {}};
    }
    case kArgString: {
      if (counted && data[0] == data.size() - 1)
        return {Argument::Kind::kString, 0, Bytes(data.begin() + 1, data.end())};
      // A string of the manual ends with NUL and has none inside; so a final NUL decides.
      if (data.back() == 0) {
        const auto end = std::ranges::find(data, 0);
        return {Argument::Kind::kString, 0, Bytes(data.begin(), end)};
      }
      if (data[0] == data.size() - 1)
        return {Argument::Kind::kString, 0, Bytes(data.begin() + 1, data.end())};
      return {Argument::Kind::kBroken, 0, {}};
    }
    default:
      return {Argument::Kind::kBroken, 0, {}};
  }
}

// MobileSim: three 32-bit integers behind a meaningless type byte.
Bytes with_pose(Number number, const Pose& pose) {
  Bytes body{static_cast<std::uint8_t>(number), kArgInt};
  put(body, rounded(pose.x * 1000.0, -2'000'000'000, 2'000'000'000));
  put(body, rounded(pose.y * 1000.0, -2'000'000'000, 2'000'000'000));
  put(body, std::isfinite(pose.th) ? rounded(degrees(norm2_angle(pose.th)), -180, 180) : 0);
  return frame(body);
}

std::optional<Pose> read_pose(ByteView body) {
  if (body.size() < 14)
    return std::nullopt;
  Fields in(body.subspan(2));
  const double x = in.number<std::int32_t>() / 1000.0;
  const double y = in.number<std::int32_t>() / 1000.0;
  return Pose{x, y, norm2_angle(radians(in.number<std::int32_t>()))};
}

// A command that is a number and an argument.
Command decode_plain(ByteView body) {
  const CommandRule* found = rule(body[0]);
  if (found == nullptr)
    return Unknown{body[0]};
  const Number number = found->number;
  static constexpr Number bare[]{
      Number::kPulse,      Number::kOpen,     Number::kClose,         Number::kSetOrigin,
      Number::kStep,       Number::kStop,     Number::kEmergencyStop, Number::kEmergencyStop2,
      Number::kTrueOrigin, Number::kSimReset, Number::kReset,         Number::kMaintenance};
  if (std::find(std::begin(bare), std::end(bare), number) != std::end(bare))
    return Bare{number};
  if (found->form == ArgumentForm::kRaw)
    return Raw{number, Bytes(body.begin() + 1, body.end())};
  const bool text = found->form == ArgumentForm::kString;
  const Argument argument = read_argument(body, text);
  const bool none = argument.kind == Argument::Kind::kNone;
  if (text && (none || argument.kind == Argument::Kind::kString))
    return Text{number, argument.text};
  if (!text && (none || argument.kind == Argument::Kind::kInt))
    return Integer{number, argument.value};
  return Unknown{body[0]};
}

// The one of these commands that has the number.
template <class... Quantities>
std::optional<Command> quantity_of(Number number, int value) {
  std::optional<Command> found;
  ((Quantities::kNumber == number ? void(found = Quantities::of_packet(value)) : void()), ...);
  return found;
}

// A command with a type of its own whose argument is a number.
std::optional<Command> decode_number(Number number, const Argument& argument, ByteView body,
                                     double vel2_unit) {
  const int value = argument.value;
  // The devices' arguments are bit patterns or counts: no sign.
  const auto word = static_cast<std::uint16_t>(value & 0xFFFF);
  switch (number) {
    case Number::kHeading:
      return Heading{radians(value)};
    case Number::kWheelVelocities: {
      if (argument.kind != Argument::Kind::kInt)
        return WheelVelocities{};
      const auto right = static_cast<std::int8_t>(body[2]);
      const auto left = static_cast<std::int8_t>(body[3]);
      return WheelVelocities{left * vel2_unit, right * vel2_unit};
    }
    case Number::kDigitalOutput:
      return DigitalOutput{static_cast<std::uint8_t>(word & 0xFFU),
                           static_cast<std::uint8_t>(word >> 8U)};
    case Number::kTimer:
      return word < 8 ? Command{Timer{static_cast<std::uint8_t>(word)}} : Command{Unknown{body[0]}};
    case Number::kGripper:
      return Gripper{word};
    case Number::kPtu:
      return Ptu{word};
    case Number::kEnable:
      return Enable{value != 0};
    case Number::kSonar:
      return SonarSwitch{(word & 1U) != 0, static_cast<std::uint8_t>(word >> 1U & 0x7FU)};
    default:
      return quantity_of<Velocity, DeltaHeading, RotationVelocity, Acceleration, MaxVelocity, Move,
                         Rotate, MaxRotationVelocity, RotationAcceleration, DeltaSetpoint,
                         LateralVelocity>(number, value);
  }
}

}  // namespace

Bytes encode(const Command& command, double vel2_unit, StringForm form) {
  return std::visit(
      Overloaded{
          [form](const Polling& c) {
            Bytes text;
            for (const std::uint8_t sonar : c.sonars)
              if (text.size() < kMaxPolling && sonar < 255)
                text.push_back(static_cast<std::uint8_t>(sonar + 1));
            return with_string(Number::kPolling, text, form);
          },
          []<Number N, PacketUnit unit, int low, int high>(const Quantity<N, unit, low, high>& c) {
            const double whole = unit == PacketUnit::kMilli ? c.value * 1000.0 : degrees(c.value);
            return with_int(N, rounded(whole, low, high));
          },
          [](const Heading& c) {
            const int whole = std::isfinite(c.heading)
                                  ? rounded(degrees(norm_angle(c.heading)), 0, 360) % 360
                                  : 0;
            return with_int(Number::kHeading, whole);
          },
          [vel2_unit](const WheelVelocities& c) {
            const int left = rounded(c.left / vel2_unit, -127, 127);
            const int right = rounded(c.right / vel2_unit, -127, 127);
            // Two signed bytes, the right wheel in the low one. Not an integer: never negated.
            const Bytes body{static_cast<std::uint8_t>(Number::kWheelVelocities), kArgInt,
                             static_cast<std::uint8_t>(right & 0xFF),
                             static_cast<std::uint8_t>(left & 0xFF)};
            return frame(body);
          },
          [](const DigitalOutput& c) {
            return with_int(Number::kDigitalOutput, c.bits | c.mask << 8);
          },
          [](const Timer& c) { return with_int(Number::kTimer, c.pin); },
          [](const Gripper& c) { return with_int(Number::kGripper, c.state); },
          [](const Ptu& c) { return with_int(Number::kPtu, c.width); },
          [](const Enable& c) { return with_int(Number::kEnable, c.on ? 1 : 0); },
          [](const SonarSwitch& c) {
            return with_int(Number::kSonar, (c.on ? 1 : 0) | c.array << 1);
          },
          [](const TruePose& c) { return with_pose(Number::kTruePose, c.pose_in_world); },
          [](const Bare& c) { return bare(c.number); },
          [](const Integer& c) { return with_int(c.number, std::clamp(c.value, -32767, 65535)); },
          [](const Text& c) {
            const std::size_t size = std::min(c.text.size(), kMaxBody - 3);
            const Bytes text(c.text.begin(), c.text.begin() + static_cast<std::ptrdiff_t>(size));
            return with_string(c.number, text, StringForm::kLengthPrefixed);
          },
          [](const Raw& c) {
            Bytes body{static_cast<std::uint8_t>(c.number)};
            const std::size_t size = std::min(c.argument.size(), kMaxBody - 1);
            body.insert(body.end(), c.argument.begin(),
                        c.argument.begin() + static_cast<std::ptrdiff_t>(size));
            return frame(body);
          },
          [](const Unknown& c) {
            const Bytes body{c.number};
            return frame(body);
          },
      },
      command);
}

Bytes encode(const Command& command, const RobotParameters& parameters) {
  return encode(command, parameters.vel2_unit,
                parameters.protocol == Protocol::kPsos ? StringForm::kNulTerminated
                                                       : StringForm::kLengthPrefixed);
}

Command decode_command(ByteView body, double vel2_unit) {
  if (body.empty())
    return Unknown{};
  const Unknown unknown{body[0]};
  const Argument argument = read_argument(body, false);
  const auto number = static_cast<Number>(body[0]);
  if (number == Number::kTruePose) {
    const auto pose = read_pose(body);
    return pose ? Command{TruePose{*pose}} : Command{unknown};
  }
  if (number == Number::kPolling) {
    if (argument.kind != Argument::Kind::kString && argument.kind != Argument::Kind::kNone)
      return unknown;
    Polling polling;
    for (const std::uint8_t byte : argument.text)
      if (byte > 0 && polling.sonars.size() < kMaxPolling)
        polling.sonars.push_back(static_cast<std::uint8_t>(byte - 1));
    return polling;
  }
  const std::optional<Command> typed = decode_number(number, argument, body, vel2_unit);
  if (!typed)
    return decode_plain(body);
  return argument.kind == Argument::Kind::kInt || argument.kind == Argument::Kind::kNone
             ? *typed
             : Command{unknown};
}

std::string name_of(const RobotIdentity& robot) {
  return "robot \"" + robot.name + "\" (" + robot.robot_class + ", " + robot.subclass + ")";
}

Bytes encode_sync(int number) {
  const Bytes body{static_cast<std::uint8_t>(number)};
  return frame(body);
}

Bytes encode_sync2_reply(const RobotIdentity& identity) {
  Bytes body{2};
  std::size_t left = kMaxBody - 1 - 3;  // the three NULs
  for (const std::string* text : {&identity.name, &identity.robot_class, &identity.subclass}) {
    const std::size_t before = body.size();
    put(body, text->substr(0, left));
    left -= body.size() - before - 1;
  }
  return frame(body);
}

std::optional<int> sync_number(ByteView body) {
  if (body.empty() || body[0] > 2)
    return std::nullopt;
  return body[0];
}

std::optional<RobotIdentity> decode_sync2_reply(ByteView body) {
  if (body.empty() || body[0] != 2)
    return std::nullopt;
  Fields in(body.subspan(1));
  RobotIdentity identity;
  for (std::string* text : {&identity.name, &identity.robot_class, &identity.subclass})
    *text = in.string();
  return identity;
}

}  // namespace saphira::protocol
