#include "saphira/protocol/information.hpp"

#include <algorithm>

namespace saphira::protocol {

namespace {

constexpr unsigned kPositionMask = 0x7FFF;

void put16(Bytes& out, unsigned value) {
  out.push_back(static_cast<std::uint8_t>(value & 0xFFU));
  out.push_back(static_cast<std::uint8_t>(value >> 8U & 0xFFU));
}

// Little-endian fields one after the other; zero and a mark where the packet has ended.
class Fields {
 public:
  explicit Fields(ByteView bytes) : bytes_(bytes) {}

  std::uint8_t u8() {
    if (at_ >= bytes_.size()) {
      ended_ = true;
      return 0;
    }
    return bytes_[at_++];
  }
  std::uint16_t u16() {
    const unsigned low = u8();
    const unsigned high = u8();
    // Half a field is none.
    return ended_ ? std::uint16_t{0} : static_cast<std::uint16_t>(low | high << 8U);
  }
  std::int16_t i16() { return static_cast<std::int16_t>(u16()); }
  bool ended() const { return ended_; }

 private:
  ByteView bytes_;
  std::size_t at_ = 0;
  bool ended_ = false;
};

}  // namespace

Bytes encode(const InformationPacket& packet) {
  Bytes body;
  body.reserve(25 + 3 * packet.sonars.size());
  body.push_back(static_cast<std::uint8_t>(0x30U | static_cast<unsigned>(packet.motors)));
  put16(body, packet.x & kPositionMask);
  put16(body, packet.y & kPositionMask);
  put16(body, static_cast<std::uint16_t>(packet.th));
  put16(body, static_cast<std::uint16_t>(packet.left_velocity));
  put16(body, static_cast<std::uint16_t>(packet.right_velocity));
  body.push_back(packet.battery);
  body.push_back(packet.left_stall);
  body.push_back(packet.right_stall);
  put16(body, static_cast<std::uint16_t>(packet.control));
  put16(body, packet.ptu);
  body.push_back(packet.say);
  const std::size_t count = std::min(packet.sonars.size(), kMaxSonarsInPacket);
  body.push_back(static_cast<std::uint8_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    body.push_back(packet.sonars[i].number);
    put16(body, packet.sonars[i].range);
  }
  put16(body, packet.timer);
  body.push_back(packet.analog);
  body.push_back(packet.digital_input);
  body.push_back(packet.digital_output);
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
  packet.x = static_cast<std::uint16_t>(in.u16() & kPositionMask);
  packet.y = static_cast<std::uint16_t>(in.u16() & kPositionMask);
  packet.th = in.i16();
  packet.left_velocity = in.i16();
  packet.right_velocity = in.i16();
  packet.battery = in.u8();
  packet.left_stall = in.u8();
  packet.right_stall = in.u8();
  packet.control = in.i16();
  packet.ptu = in.u16();
  packet.say = in.u8();
  const std::size_t count = in.u8();
  for (std::size_t i = 0; i < count && !in.ended(); ++i) {
    const std::uint8_t number = in.u8();
    packet.sonars.push_back({number, in.u16()});
  }
  if (in.ended())
    return std::nullopt;
  packet.timer = in.u16();
  packet.analog = in.u8();
  packet.digital_input = in.u8();
  packet.digital_output = in.u8();
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
  out.say = packet.say;
  out.sonars.reserve(packet.sonars.size());
  for (const RawSonar& raw : packet.sonars) {
    const double range = raw.range * parameters.range_unit;
    // Half a unit, since 5000 mm is seldom a whole number of units.
    out.sonars.push_back({raw.number, range, range < kNoEcho - parameters.range_unit / 2.0});
  }
  out.timer = packet.timer;
  out.analog = packet.analog;
  out.digital_input = packet.digital_input;
  out.digital_output = packet.digital_output;
  return out;
}

int position_difference(std::uint16_t from, std::uint16_t to) {
  const auto forward = static_cast<int>((static_cast<unsigned>(to) - from) & kPositionMask);
  return forward > 0x3FFF ? forward - 0x8000 : forward;
}

Pose DeadReckoning::update(const InformationPacket& packet, const RobotParameters& parameters) {
  if (known_) {
    x_ += position_difference(last_x_, packet.x);
    y_ += position_difference(last_y_, packet.y);
  } else {
    x_ = packet.x;
    y_ = packet.y;
    known_ = true;
  }
  last_x_ = packet.x;
  last_y_ = packet.y;
  return {static_cast<double>(x_) * parameters.distance_unit,
          static_cast<double>(y_) * parameters.distance_unit,
          norm2_angle(packet.th * parameters.angle_unit)};
}

}  // namespace saphira::protocol
