#include "saphira/protocol/server_packet.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>
#include <utility>

#include "fields.hpp"
#include "saphira/base/members.hpp"
#include "saphira/base/overloaded.hpp"

namespace saphira::protocol {

namespace {

Bytes finish(Bytes body) {
  body.resize(std::min(body.size(), kMaxBody));
  return frame(body);
}

constexpr std::pair<PacketType, std::string_view> kNames[] = {
    {PacketType::kConfig, "CONFIG"},
    {PacketType::kNoPower, "information"},
    {PacketType::kStopped, "information"},
    {PacketType::kMoving, "information"},
    {PacketType::kNoPower2, "information"},
    {PacketType::kSimLaser, "simulated laser"},
    {PacketType::kSimLaserExtended, "simulated laser, extended"},
    {PacketType::kSimStatus, "SIMSTAT"},
    {PacketType::kSimInfo, "SIMINFO"},
    {PacketType::kSimMapChanged, "simulator's map changed"},
    {PacketType::kAcceleration, "acceleration"},
    {PacketType::kTorque, "torque"},
    {PacketType::kVision, "vision"},
    {PacketType::kEncoder, "ENCODER"},
    {PacketType::kHeading, "heading"},
    {PacketType::kGyro, "GYRO"},
    {PacketType::kImu, "IMU"},
    {PacketType::kArmStatus, "ARM status"},
    {PacketType::kArmInfo, "ARM info"},
    {PacketType::kAux1, "SERAUX"},
    {PacketType::kAux2, "SERAUX2"},
    {PacketType::kAux3, "SERAUX3"},
    {PacketType::kCompass, "COMPASS"},
    {PacketType::kPlaylist, "PLAYLIST"},
    {PacketType::kGripper, "GRIPPER"},
    {PacketType::kIo, "IO"},
    {PacketType::kJoystick, "JOYSTICK"},
    {PacketType::kBattery, "BATTERY"},
    {PacketType::kReset1, "controller reset"},
    {PacketType::kReset2, "controller reset"},
};

// ---- The fields of each packet: one list writes and reads them.

template <class T, class Packet>
concept Is = std::is_same_v<std::remove_const_t<T>, Packet>;

void fields(auto& packet, const auto& visit) {
  std::apply([&](auto&... members) { each(visit, members...); }, members_of(packet));
}

void fields(Is<IoPacket> auto& p, const auto& visit) {
  visit(p.digital_inputs, 32);
  visit(p.digital_outputs, 32);
  visit(p.analogs, 64);
}

void fields(Is<GyroPacket> auto& p, const auto& visit) {
  visit(p.readings, 64);
}

void fields(Is<BatteryPacket> auto& p, const auto& visit) {
  visit(p.batteries);
  visit(p.bytes_each);
  visit.rest(p.data);
}

void fields(Is<VisionPacket> auto& p, const auto& visit) {
  using Mode = VisionChannel::Mode;
  for (auto& channel : p.channels) {
    visit(channel.mode);
    visit(channel.x);
    if (channel.mode == Mode::kLine) {
      visit(channel.first);
      visit(channel.count);
      continue;
    }
    visit(channel.y);
    visit(channel.area);
    if (channel.mode == Mode::kBlobWithBox) {
      visit(channel.height);
      visit(channel.width);
    }
  }
}

void fields(Is<SimLaserPacket> auto& p, const auto& visit) {
  each(visit, p.x, p.y, p.th, p.total, p.first);
  visit(p.ranges, (kMaxBody - 12) / 2);
}

void fields(Is<SimStatusPacket> auto& p, const auto& visit) {
  std::uint16_t unused = 0;
  visit(unused);
  std::apply([&](auto&... members) { each(visit, members...); }, members_of(p));
}

struct Put : PutField {
  using PutField::operator();
  void operator()(const std::string& text) const { put(out, text); }
  void operator()(VisionChannel::Mode mode) const { put(out, static_cast<std::uint8_t>(mode)); }
  void operator()(const GyroPacket::Reading& reading) const {
    (*this)(reading.rate);
    (*this)(reading.temperature);
  }
  /// Behind their number; those that are too many are left out.
  template <class T>
  void operator()(const std::vector<T>& items, std::size_t most) const {
    const std::size_t count = std::min(items.size(), most);
    put(out, static_cast<std::uint8_t>(count));
    for (std::size_t i = 0; i < count; ++i)
      (*this)(items[i]);
  }
  void rest(const Bytes& bytes) const { out.insert(out.end(), bytes.begin(), bytes.end()); }
};

struct Get : GetField {
  using GetField::operator();
  void operator()(std::string& text) const { text = in.string(); }
  void operator()(VisionChannel::Mode& mode) const {
    const std::uint8_t value = in.u8();
    if (value <= static_cast<unsigned>(VisionChannel::Mode::kBlobWithBox)) {
      mode = static_cast<VisionChannel::Mode>(value);
      return;
    }
    in.rest();  // unknown mode: the rest cannot be read
    in.u8();
  }
  void operator()(GyroPacket::Reading& reading) const {
    (*this)(reading.rate);
    (*this)(reading.temperature);
  }
  template <class T>
  void operator()(std::vector<T>& items, std::size_t /*most*/) const {
    const std::size_t count = in.u8();
    for (std::size_t i = 0; i < count && !in.ended(); ++i)
      (*this)(items.emplace_back());
  }
  void rest(Bytes& bytes) const { bytes = in.rest(); }
};

template <class Packet>
Packet read_packet(Fields& in) {
  Packet out;
  fields(out, Get{in});
  return out;
}

template <class... Packets>
std::optional<ServerPacket> read_one_of(PacketType type, Fields& in) {
  std::optional<ServerPacket> out;
  static_cast<void>(((type == Packets::kType && (out = read_packet<Packets>(in), true)) || ...));
  return out;
}

std::optional<ServerPacket> decode_known(PacketType type, Fields& in) {
  switch (type) {
    case PacketType::kConfig: {
      ConfigPacket out;
      // The older servers' packets end early; their first strings identify them.
      out.robot_class = in.string();
      out.subclass = in.string();
      if (in.ended())
        return std::nullopt;
      return out;
    }
    case PacketType::kAux1:
      return AuxPacket{1, in.rest()};
    case PacketType::kAux2:
      return AuxPacket{2, in.rest()};
    case PacketType::kAux3:
      return AuxPacket{3, in.rest()};
    default:
      return read_one_of<EncoderPacket, IoPacket, GripperPacket, GyroPacket, JoystickPacket,
                         BatteryPacket, VisionPacket, SimLaserPacket, SimStatusPacket>(type, in);
  }
}

std::uint16_t counts(double value) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0, 65535.0)));
}

}  // namespace

ServerPacket decode_packet(ByteView body) {
  if (body.empty())
    return OtherPacket{};
  if (auto information = decode_information(body))
    return *std::move(information);
  Fields in(body.subspan(1));
  auto packet = decode_known(static_cast<PacketType>(body[0]), in);
  if (!packet || in.ended())
    return OtherPacket{body[0], Bytes(body.begin() + 1, body.end())};
  if (auto* config = std::get_if<ConfigPacket>(&*packet)) {
    Fields all(body.subspan(1));
    fields(*config, Get{all});
  }
  return *std::move(packet);
}

bool is_read(PacketType type) {
  // Zeros give a packet of each type that has a reader.
  const Bytes zeros(kMaxBody);
  Fields in(zeros);
  return decode_known(type, in).has_value();
}

Bytes encode(const ServerPacket& packet) {
  const auto of_bytes = [](std::uint8_t type, const Bytes& bytes) {
    Bytes body{type};
    body.insert(body.end(), bytes.begin(), bytes.end());
    return finish(std::move(body));
  };
  return std::visit(Overloaded{[](const InformationPacket& p) { return encode(p); },
                               [&](const AuxPacket& p) {
                                 const PacketType type = p.line <= 1   ? PacketType::kAux1
                                                         : p.line == 2 ? PacketType::kAux2
                                                                       : PacketType::kAux3;
                                 return of_bytes(static_cast<std::uint8_t>(type), p.bytes);
                               },
                               [&](const OtherPacket& p) { return of_bytes(p.type, p.data); },
                               [](const auto& p) {
                                 Bytes body{static_cast<std::uint8_t>(p.kType)};
                                 fields(p, Put{body});
                                 return finish(std::move(body));
                               }},
                    packet);
}

std::string_view packet_type_name(std::uint8_t type) {
  for (const auto& [known, name] : kNames)
    if (static_cast<std::uint8_t>(known) == type)
      return name;
  return {};
}

ConfigPacket config_of(const RobotParameters& parameters, const std::string& name,
                       const std::string& serial) {
  const RobotParameters& p = parameters;
  ConfigPacket c{
      .robot_class = p.robot_class, .subclass = p.subclass, .serial = serial, .four_motors = 0};
  // The top values are the robot's limits, the others its present settings.
  c.rotation_velocity_top = c.rotation_velocity_max = counts(degrees(p.max_rotation_velocity));
  c.velocity_top = c.velocity_max = counts(p.max_velocity * 1000.0);
  c.rotation_acceleration = counts(degrees(p.rotation_acceleration));
  c.rotation_deceleration = counts(degrees(p.rotation_deceleration));
  c.rotation_acceleration_top = std::max({counts(degrees(p.max_rotation_acceleration)),
                                          c.rotation_acceleration, c.rotation_deceleration});
  c.acceleration = counts(p.acceleration * 1000.0);
  c.deceleration = counts(p.deceleration * 1000.0);
  c.acceleration_top =
      std::max({counts(p.max_acceleration * 1000.0), c.acceleration, c.deceleration});
  c.pwm_max = 500;
  c.name = name;
  c.cycle = 100;
  c.gripper = p.gripper ? 1 : 0;
  c.front_sonar = p.sonar_arrays > 0 && !p.sonars.empty() ? 1 : 0;
  c.rear_sonar = p.sonar_arrays > 1 ? 1 : 0;
  c.low_battery = counts(p.low_battery * 10.0);
  c.watchdog = counts(p.watchdog * 1000.0);
  c.normal_packets = 1;
  c.joystick_velocity = c.velocity_max;
  c.joystick_rotation_velocity = c.rotation_velocity_max;
  c.front_bumpers = static_cast<std::uint8_t>(p.front_bumpers);
  c.rear_bumpers = static_cast<std::uint8_t>(p.rear_bumpers);
  c.charger = p.charger ? 1 : 0;
  c.sonar_cycle = static_cast<std::uint8_t>(std::min<int>(counts(p.sonar_period * 1000.0), 255));
  c.reset_baud = p.switch_to_baud != 0 ? 2 : 0;
  c.gyro_type = p.gyro ? 2 : 0;
  c.encoder_ticks_per_mm = p.encoder_unit > 0.0 ? counts(0.001 / p.encoder_unit) : std::uint16_t{0};
  c.shutdown_volts = counts(p.shutdown_voltage * 10.0);
  return c;
}

}  // namespace saphira::protocol
