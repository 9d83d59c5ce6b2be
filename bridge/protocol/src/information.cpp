#include "saphira/protocol/information.hpp"

#include <algorithm>

#include "fields.hpp"

namespace saphira::protocol {

namespace {

constexpr unsigned kPositionMask = 0x7FFF;
constexpr std::size_t kMinBody = 25;  // without sonars and trailing fields
constexpr int kCompassTurn = 181;     // [2 deg] a whole turn; some servers count it from 1

// In order, behind the position, and behind the sonars.
void each_before_sonars(auto& p, const auto& visit) {
  each(visit, p.th, p.left_velocity, p.right_velocity, p.battery, p.left_stall, p.right_stall,
       p.control, p.ptu, p.say);
}
void each_behind_sonars(auto& p, const auto& visit) {
  each(visit, p.timer, p.analog, p.digital_input, p.digital_output);
}

// In order, up to the first that is missing.
void each_trailing(auto& more, const auto& visit) {
  visit(more.battery) && visit(more.charge_state) && visit(more.rotation) && visit(more.faults) &&
      visit(more.lateral) && visit(more.temperature) && visit(more.state_of_charge) &&
      visit(more.time) && visit(more.flags3);
}

void put_trailing(Bytes& body, const TrailingFields& more) {
  each_trailing(more, [&](const auto& field) {
    if (field)
      PutField{body}(*field);
    return field.has_value();
  });
}

TrailingFields read_trailing(Fields& in) {
  TrailingFields more;
  each_trailing(more, [&](auto& field) {
    if (in.left() < sizeof *field)
      return false;
    GetField{in}(field.emplace());
    return true;
  });
  return more;
}

// Switches from the left, bit 0 the first.
std::uint8_t bumper_bits(unsigned stall_byte, int count) {
  return static_cast<std::uint8_t>(stall_byte >> 1U & ((1U << static_cast<unsigned>(count)) - 1U));
}

void interpret_later(const InformationPacket& packet, const RobotParameters& parameters,
                     Information& out) {
  out.front_bumpers = bumper_bits(packet.right_stall, parameters.front_bumpers);
  out.rear_bumpers = bumper_bits(packet.left_stall, parameters.rear_bumpers);
  out.gripper_bits = static_cast<std::uint8_t>(packet.timer >> 8U);
  if (parameters.compass && packet.say <= kCompassTurn)
    out.compass = norm2_angle(radians(2.0 * packet.say));
  if (parameters.protocol != Protocol::kArcos)
    return;
  out.motors_on = (packet.ptu & kFlagMotors) != 0;
  out.emergency_stop = (packet.ptu & kFlagEmergencyStop) != 0;
  if (!*out.motors_on)
    out.motors = Motors::kNoPower;
  out.ptu = 0;
  const TrailingFields& more = packet.trailing;
  if (more.battery && *more.battery > 0)
    out.battery = *more.battery / 10.0;
  out.charge_state = more.charge_state;
  if (more.rotation)
    out.rotation_velocity = radians(*more.rotation / 10.0);
  out.faults = more.faults;
  if (more.lateral)
    out.lateral_velocity = *more.lateral / 1000.0;
  if (more.temperature && *more.temperature > -127)
    out.temperature = *more.temperature;
  if (more.state_of_charge && *more.state_of_charge > 0)
    out.state_of_charge = std::min(*more.state_of_charge / 100.0, 1.0);
}

}  // namespace

bool is_information(std::uint8_t type) {
  return type >= 0x31 && type <= 0x34;
}

Bytes encode(const InformationPacket& packet) {
  Bytes body;
  body.reserve(kMinBody + 3 * packet.sonars.size());
  body.push_back(static_cast<std::uint8_t>(0x30U | static_cast<unsigned>(packet.motors)));
  put(body, static_cast<std::uint16_t>(packet.x & kPositionMask));
  put(body, static_cast<std::uint16_t>(packet.y & kPositionMask));
  each_before_sonars(packet, PutField{body});
  Bytes trailing;
  put_trailing(trailing, packet.trailing);
  const std::size_t count =
      std::min(packet.sonars.size(), (kMaxBody - kMinBody - trailing.size()) / 3);
  body.push_back(static_cast<std::uint8_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    body.push_back(packet.sonars[i].number);
    put(body, packet.sonars[i].range);
  }
  each_behind_sonars(packet, PutField{body});
  body.insert(body.end(), trailing.begin(), trailing.end());
  return frame(body);
}

std::optional<InformationPacket> decode_information(ByteView body) {
  Fields in(body);
  InformationPacket packet;
  switch (in.u8()) {
    case 0x31:
    case 0x34:  // some servers' number for motors without power
      packet.motors = Motors::kNoPower;
      break;
    case 0x32:
      packet.motors = Motors::kStopped;
      break;
    case 0x33:
      packet.motors = Motors::kMoving;
      break;
    default:
      return std::nullopt;
  }
  packet.x = static_cast<std::uint16_t>(in.number<std::uint16_t>() & kPositionMask);
  packet.y = static_cast<std::uint16_t>(in.number<std::uint16_t>() & kPositionMask);
  each_before_sonars(packet, GetField{in});
  const std::size_t count = in.u8();
  for (std::size_t i = 0; i < count && !in.ended(); ++i) {
    const std::uint8_t number = in.u8();
    packet.sonars.push_back({number, in.number<std::uint16_t>()});
  }
  if (in.ended())
    return std::nullopt;
  each_behind_sonars(packet, GetField{in});
  packet.trailing = read_trailing(in);
  packet.unknown_bytes = in.left();
  return packet;
}

Information interpret(const InformationPacket& packet, const RobotParameters& parameters) {
  Information out;
  out.motors = packet.motors;
  out.th = norm2_angle(packet.th * parameters.angle_unit);
  out.left_velocity = packet.left_velocity * parameters.velocity_unit;
  out.right_velocity = packet.right_velocity * parameters.velocity_unit;
  out.velocity = (out.left_velocity + out.right_velocity) / 2.0;
  out.rotation_velocity =
      (out.right_velocity - out.left_velocity) / 2.0 * parameters.rotation_per_difference;
  out.battery = packet.battery / 10.0;
  // The other bits are the bumpers of later robots.
  out.left_stalled = (packet.left_stall & 1U) != 0;
  out.right_stalled = (packet.right_stall & 1U) != 0;
  out.bumpers = static_cast<std::uint16_t>(packet.left_stall |
                                           static_cast<unsigned>(packet.right_stall) << 8U);
  out.control = norm2_angle(packet.control * parameters.angle_unit);
  out.ptu = packet.ptu;
  out.head = angle_of_head(parameters, packet.ptu);
  out.say = packet.say;
  out.sonars.reserve(packet.sonars.size());
  for (const RawSonar& raw : packet.sonars) {
    const double range = raw.range * parameters.range_unit;
    // Half a unit, since 5000 mm is seldom a whole number of units.
    const bool echo = range < kNoEcho - parameters.range_unit / 2.0;
    out.sonars.push_back({raw.number, std::min(range, kNoEcho), echo});
  }
  out.timer = packet.timer;
  out.analog = packet.analog;
  out.digital_input = packet.digital_input;
  out.digital_output = packet.digital_output;
  if (parameters.protocol != Protocol::kPsos)
    interpret_later(packet, parameters, out);
  return out;
}

int position_difference(std::uint16_t from, std::uint16_t to) {
  const auto forward = static_cast<int>((static_cast<unsigned>(to) - from) & kPositionMask);
  return forward > 0x3FFF ? forward - 0x8000 : forward;
}

}  // namespace saphira::protocol
