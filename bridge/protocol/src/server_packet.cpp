#include "saphira/protocol/server_packet.hpp"

#include <algorithm>
#include <cmath>

#include "fields.hpp"

namespace saphira::protocol {

namespace {

Bytes begin(PacketType type) {
  return {static_cast<std::uint8_t>(type)};
}

Bytes finish(Bytes body) {
  body.resize(std::min(body.size(), kMaxBody));
  return frame(body);
}

// ---- CONFIG is long; one list of its fields writes and reads it.

struct Put {
  Bytes& out;
  void operator()(const std::string& text) const { put_string(out, text); }
  void operator()(std::uint8_t value) const { put8(out, value); }
  void operator()(std::uint16_t value) const { put16(out, unsigned{value}); }
  void operator()(std::int16_t value) const { put16(out, value); }
};

struct Get {
  Fields& in;
  void operator()(std::string& text) const { text = in.string(); }
  void operator()(std::uint8_t& value) const { value = in.u8(); }
  void operator()(std::uint16_t& value) const { value = in.u16(); }
  void operator()(std::int16_t& value) const { value = in.i16(); }
};

template <class Config, class Visit>
void each_field(Config& c, const Visit& visit) {
  visit(c.robot_class);
  visit(c.subclass);
  visit(c.serial);
  visit(c.four_motors);
  visit(c.rotation_velocity_top);
  visit(c.velocity_top);
  visit(c.rotation_acceleration_top);
  visit(c.acceleration_top);
  visit(c.pwm_max);
  visit(c.name);
  visit(c.cycle);
  visit(c.host_baud);
  visit(c.aux1_baud);
  visit(c.gripper);
  visit(c.front_sonar);
  visit(c.rear_sonar);
  visit(c.low_battery);
  visit(c.revolution_count);
  visit(c.watchdog);
  visit(c.normal_packets);
  visit(c.stall_value);
  visit(c.stall_count);
  visit(c.joystick_velocity);
  visit(c.joystick_rotation_velocity);
  visit(c.rotation_velocity_max);
  visit(c.velocity_max);
  visit(c.rotation_acceleration);
  visit(c.rotation_deceleration);
  visit(c.rotation_kp);
  visit(c.rotation_kv);
  visit(c.rotation_ki);
  visit(c.acceleration);
  visit(c.deceleration);
  visit(c.translation_kp);
  visit(c.translation_kv);
  visit(c.translation_ki);
  visit(c.front_bumpers);
  visit(c.rear_bumpers);
  visit(c.charger);
  visit(c.sonar_cycle);
  visit(c.reset_baud);
  visit(c.gyro_type);
  visit(c.drift_factor);
  visit(c.aux2_baud);
  visit(c.aux3_baud);
  visit(c.encoder_ticks_per_mm);
  visit(c.shutdown_volts);
  visit(c.firmware);
  visit(c.gyro_clockwise);
  visit(c.gyro_counter_clockwise);
  visit(c.kinematics_delay);
  visit(c.lateral_velocity_top);
  visit(c.lateral_acceleration_top);
  visit(c.lateral_velocity_max);
  visit(c.lateral_acceleration);
  visit(c.lateral_deceleration);
  visit(c.charge_threshold);
}

Bytes counted(Fields& in) {
  const std::size_t count = in.u8();
  Bytes out;
  for (std::size_t i = 0; i < count && !in.ended(); ++i)
    out.push_back(in.u8());
  return out;
}

IoPacket read_io(Fields& in) {
  IoPacket out;
  out.digital_inputs = counted(in);
  out.digital_outputs = counted(in);
  const std::size_t count = in.u8();
  for (std::size_t i = 0; i < count && !in.ended(); ++i)
    out.analogs.push_back(in.u16());
  return out;
}

GyroPacket read_gyro(Fields& in) {
  GyroPacket out;
  const std::size_t count = in.u8();
  for (std::size_t i = 0; i < count && !in.ended(); ++i) {
    const std::uint16_t rate = in.u16();
    out.readings.push_back({rate, in.u8()});
  }
  return out;
}

VisionPacket read_vision(Fields& in) {
  using Mode = VisionChannel::Mode;
  VisionPacket out;
  for (VisionChannel& channel : out.channels) {
    const std::uint8_t mode = in.u8();
    if (mode > 2) {
      in.u8();  // unknown mode: the rest cannot be read
      while (!in.ended())
        in.u8();
      return out;
    }
    channel.mode = static_cast<Mode>(mode);
    channel.x = in.i16();
    if (channel.mode == Mode::kLine) {
      channel.first = in.u16();
      channel.count = in.u16();
      continue;
    }
    channel.y = in.i16();
    channel.area = in.u16();
    if (channel.mode == Mode::kBlobWithBox) {
      channel.height = in.u16();
      channel.width = in.u16();
    }
  }
  return out;
}

SimLaserPacket read_sim_laser(Fields& in) {
  SimLaserPacket out;
  out.x = in.i16();
  out.y = in.i16();
  out.th = in.i16();
  out.total = in.u16();
  out.first = in.u16();
  const std::size_t count = in.u8();
  for (std::size_t i = 0; i < count && !in.ended(); ++i)
    out.ranges.push_back(in.u16());
  return out;
}

SimStatusPacket read_sim_status(Fields& in) {
  SimStatusPacket out;
  in.u16();
  out.flags = in.u32();
  out.sim_interval = in.u16();
  out.real_interval = in.u16();
  out.last_interval = in.u16();
  out.true_x = in.i32();
  out.true_y = in.i32();
  out.true_z = in.i32();
  out.true_th = in.i32();
  out.latitude = in.i32();
  out.longitude = in.i32();
  out.altitude = in.i32();
  out.gps = in.i8();
  out.odometry_error_x = in.i32();
  out.odometry_error_y = in.i32();
  out.odometry_error_th = in.i32();
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
    case PacketType::kEncoder: {
      EncoderPacket out;
      out.left = in.i32();
      out.right = in.i32();
      return out;
    }
    case PacketType::kIo:
      return read_io(in);
    case PacketType::kGripper: {
      GripperPacket out;
      out.kind = in.u8();
      out.state = in.u8();
      out.grasp_time = in.u8();
      return out;
    }
    case PacketType::kAux1:
      return AuxPacket{1, in.rest()};
    case PacketType::kAux2:
      return AuxPacket{2, in.rest()};
    case PacketType::kAux3:
      return AuxPacket{3, in.rest()};
    case PacketType::kGyro:
      return read_gyro(in);
    case PacketType::kJoystick: {
      JoystickPacket out;
      out.button1 = in.u8();
      out.button2 = in.u8();
      out.x = in.u16();
      out.y = in.u16();
      out.throttle = in.u16();
      return out;
    }
    case PacketType::kBattery: {
      BatteryPacket out;
      out.batteries = in.u8();
      out.bytes_each = in.u8();
      out.data = in.rest();
      return out;
    }
    case PacketType::kVision:
      return read_vision(in);
    case PacketType::kSimLaser:
      return read_sim_laser(in);
    case PacketType::kSimStatus:
      return read_sim_status(in);
    default:
      return std::nullopt;
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
    each_field(*config, Get{all});
  }
  return *std::move(packet);
}

bool is_read(PacketType type) {
  // Zeros give a packet of each type that has a reader.
  const Bytes zeros(kMaxBody);
  Fields in(zeros);
  return decode_known(type, in).has_value();
}

Bytes encode(const ConfigPacket& packet) {
  Bytes body = begin(PacketType::kConfig);
  each_field(packet, Put{body});
  return finish(std::move(body));
}

Bytes encode(const EncoderPacket& packet) {
  Bytes body = begin(PacketType::kEncoder);
  put32(body, packet.left);
  put32(body, packet.right);
  return finish(std::move(body));
}

Bytes encode(const IoPacket& packet) {
  Bytes body = begin(PacketType::kIo);
  for (const Bytes* bits : {&packet.digital_inputs, &packet.digital_outputs}) {
    const std::size_t count = std::min<std::size_t>(bits->size(), 32);
    put8(body, static_cast<unsigned>(count));
    body.insert(body.end(), bits->begin(), bits->begin() + static_cast<std::ptrdiff_t>(count));
  }
  const std::size_t count = std::min<std::size_t>(packet.analogs.size(), 64);
  put8(body, static_cast<unsigned>(count));
  for (std::size_t i = 0; i < count; ++i)
    put16(body, unsigned{packet.analogs[i]});
  return finish(std::move(body));
}

Bytes encode(const GripperPacket& packet) {
  Bytes body = begin(PacketType::kGripper);
  put8(body, packet.kind);
  put8(body, packet.state);
  put8(body, packet.grasp_time);
  return finish(std::move(body));
}

Bytes encode(const AuxPacket& packet) {
  Bytes body = begin(packet.line <= 1   ? PacketType::kAux1
                     : packet.line == 2 ? PacketType::kAux2
                                        : PacketType::kAux3);
  body.insert(body.end(), packet.bytes.begin(), packet.bytes.end());
  return finish(std::move(body));
}

Bytes encode(const GyroPacket& packet) {
  Bytes body = begin(PacketType::kGyro);
  const std::size_t count = std::min<std::size_t>(packet.readings.size(), 64);
  put8(body, static_cast<unsigned>(count));
  for (std::size_t i = 0; i < count; ++i) {
    put16(body, unsigned{packet.readings[i].rate});
    put8(body, packet.readings[i].temperature);
  }
  return finish(std::move(body));
}

Bytes encode(const JoystickPacket& packet) {
  Bytes body = begin(PacketType::kJoystick);
  put8(body, packet.button1);
  put8(body, packet.button2);
  put16(body, unsigned{packet.x});
  put16(body, unsigned{packet.y});
  put16(body, unsigned{packet.throttle});
  return finish(std::move(body));
}

Bytes encode(const BatteryPacket& packet) {
  Bytes body = begin(PacketType::kBattery);
  put8(body, packet.batteries);
  put8(body, packet.bytes_each);
  body.insert(body.end(), packet.data.begin(), packet.data.end());
  return finish(std::move(body));
}

Bytes encode(const VisionPacket& packet) {
  using Mode = VisionChannel::Mode;
  Bytes body = begin(PacketType::kVision);
  for (const VisionChannel& channel : packet.channels) {
    put8(body, static_cast<unsigned>(channel.mode));
    put16(body, channel.x);
    if (channel.mode == Mode::kLine) {
      put16(body, unsigned{channel.first});
      put16(body, unsigned{channel.count});
      continue;
    }
    put16(body, channel.y);
    put16(body, unsigned{channel.area});
    if (channel.mode == Mode::kBlobWithBox) {
      put16(body, unsigned{channel.height});
      put16(body, unsigned{channel.width});
    }
  }
  return finish(std::move(body));
}

Bytes encode(const SimLaserPacket& packet) {
  Bytes body = begin(PacketType::kSimLaser);
  put16(body, packet.x);
  put16(body, packet.y);
  put16(body, packet.th);
  put16(body, unsigned{packet.total});
  put16(body, unsigned{packet.first});
  const std::size_t count = std::min<std::size_t>(packet.ranges.size(), (kMaxBody - 12) / 2);
  put8(body, static_cast<unsigned>(count));
  for (std::size_t i = 0; i < count; ++i)
    put16(body, unsigned{packet.ranges[i]});
  return finish(std::move(body));
}

Bytes encode(const SimStatusPacket& packet) {
  Bytes body = begin(PacketType::kSimStatus);
  put16(body, 0U);
  put32(body, packet.flags);
  put16(body, unsigned{packet.sim_interval});
  put16(body, unsigned{packet.real_interval});
  put16(body, unsigned{packet.last_interval});
  for (const std::int32_t value : {packet.true_x, packet.true_y, packet.true_z, packet.true_th,
                                   packet.latitude, packet.longitude, packet.altitude})
    put32(body, value);
  put8(body, static_cast<std::uint8_t>(packet.gps));
  for (const std::int32_t value :
       {packet.odometry_error_x, packet.odometry_error_y, packet.odometry_error_th})
    put32(body, value);
  return finish(std::move(body));
}

Bytes encode(const OtherPacket& packet) {
  Bytes body{packet.type};
  body.insert(body.end(), packet.data.begin(), packet.data.end());
  return finish(std::move(body));
}

std::string_view packet_type_name(std::uint8_t type) {
  switch (static_cast<PacketType>(type)) {
    case PacketType::kConfig:
      return "CONFIG";
    case PacketType::kNoPower:
    case PacketType::kStopped:
    case PacketType::kMoving:
    case PacketType::kNoPower2:
      return "information";
    case PacketType::kSimLaser:
      return "simulated laser";
    case PacketType::kSimLaserExtended:
      return "simulated laser, extended";
    case PacketType::kSimStatus:
      return "SIMSTAT";
    case PacketType::kSimInfo:
      return "SIMINFO";
    case PacketType::kSimMapChanged:
      return "simulator's map changed";
    case PacketType::kAcceleration:
      return "acceleration";
    case PacketType::kTorque:
      return "torque";
    case PacketType::kVision:
      return "vision";
    case PacketType::kEncoder:
      return "ENCODER";
    case PacketType::kHeading:
      return "heading";
    case PacketType::kGyro:
      return "GYRO";
    case PacketType::kImu:
      return "IMU";
    case PacketType::kArmStatus:
      return "ARM status";
    case PacketType::kArmInfo:
      return "ARM info";
    case PacketType::kAux1:
      return "SERAUX";
    case PacketType::kAux2:
      return "SERAUX2";
    case PacketType::kAux3:
      return "SERAUX3";
    case PacketType::kCompass:
      return "COMPASS";
    case PacketType::kPlaylist:
      return "PLAYLIST";
    case PacketType::kGripper:
      return "GRIPPER";
    case PacketType::kIo:
      return "IO";
    case PacketType::kJoystick:
      return "JOYSTICK";
    case PacketType::kBattery:
      return "BATTERY";
    case PacketType::kReset1:
    case PacketType::kReset2:
      return "controller reset";
  }
  return {};
}

void PacketCounters::count(ByteView body) {
  if (body.empty())
    return;
  ++all_[body[0]];
  if (packet_type_name(body[0]).empty())
    ++unknown_;
}

std::uint64_t PacketCounters::of(PacketType type) const {
  const auto found = all_.find(static_cast<std::uint8_t>(type));
  return found == all_.end() ? 0 : found->second;
}

ConfigPacket config_of(const RobotParameters& parameters, const std::string& name,
                       const std::string& serial) {
  const RobotParameters& p = parameters;
  ConfigPacket c;
  c.robot_class = p.robot_class;
  c.subclass = p.subclass;
  c.serial = serial;
  c.four_motors = 0;
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
