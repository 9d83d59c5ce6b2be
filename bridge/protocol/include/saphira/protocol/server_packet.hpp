#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "saphira/protocol/information.hpp"
#include "saphira/protocol/packet.hpp"

namespace saphira::protocol {

// ---- A server's packets besides the information packet. Units of the packets here: these are the
// devices' own.

/// The first byte of a server's packet.
enum class PacketType : std::uint8_t {
  kConfig = 0x20,
  kNoPower = 0x31,
  kStopped = 0x32,
  kMoving = 0x33,
  kNoPower2 = 0x34,  ///< some servers' number for motors without power
  kSimLaser = 0x60,
  kSimLaserExtended = 0x61,
  kSimStatus = 0x62,
  kSimInfo = 0x63,
  kSimMapChanged = 0x66,
  kAcceleration = 0x7B,
  kTorque = 0x7C,
  kVision = 0x80,  ///< our choice: see VisionPacket
  kEncoder = 0x90,
  kHeading = 0x95,
  kGyro = 0x98,
  kImu = 0x9A,
  kArmStatus = 0xA0,
  kArmInfo = 0xA1,
  kAux1 = 0xB0,
  kAux2 = 0xB8,
  kCompass = 0xC0,
  kAux3 = 0xC8,
  kPlaylist = 0xD0,
  kGripper = 0xE0,
  kIo = 0xF0,
  kJoystick = 0xF8,
  kBattery = 0xFA,
  kReset1 = 0xFE,  ///< the controller starts anew
  kReset2 = 0xFF,
};

/// CONFIGpac, the answer to CONFIG. Clients take their limits from it: with zeros in the velocities
/// and accelerations they do not drive. Fields behind the packet's end are zero.
struct ConfigPacket {
  static constexpr PacketType kType = PacketType::kConfig;
  std::string robot_class = {};
  std::string subclass = {};
  std::string serial = {};
  std::uint8_t four_motors = 0;
  std::uint16_t rotation_velocity_top = 0;      ///< [deg/s]
  std::uint16_t velocity_top = 0;               ///< [mm/s]
  std::uint16_t rotation_acceleration_top = 0;  ///< [deg/s2]
  std::uint16_t acceleration_top = 0;           ///< [mm/s2]
  std::uint16_t pwm_max = 0;
  std::string name = {};
  std::uint8_t cycle = 0;  ///< [ms] between information packets
  std::uint8_t host_baud = 0;
  std::uint8_t aux1_baud = 0;
  std::uint16_t gripper = 0;
  std::uint16_t front_sonar = 0;
  std::uint8_t rear_sonar = 0;
  std::uint16_t low_battery = 0;  ///< [0.1 V]
  std::uint16_t revolution_count = 0;
  std::uint16_t watchdog = 0;  ///< [ms]
  std::uint8_t normal_packets = 0;
  std::uint16_t stall_value = 0;
  std::uint16_t stall_count = 0;
  std::uint16_t joystick_velocity = 0;
  std::uint16_t joystick_rotation_velocity = 0;
  std::uint16_t rotation_velocity_max = 0;  ///< [deg/s]
  std::uint16_t velocity_max = 0;           ///< [mm/s]
  std::uint16_t rotation_acceleration = 0;  ///< [deg/s2]
  std::uint16_t rotation_deceleration = 0;
  std::uint16_t rotation_kp = 0;
  std::uint16_t rotation_kv = 0;
  std::uint16_t rotation_ki = 0;
  std::uint16_t acceleration = 0;  ///< [mm/s2]
  std::uint16_t deceleration = 0;
  std::uint16_t translation_kp = 0;
  std::uint16_t translation_kv = 0;
  std::uint16_t translation_ki = 0;
  std::uint8_t front_bumpers = 0;
  std::uint8_t rear_bumpers = 0;
  std::uint8_t charger = 0;
  std::uint8_t sonar_cycle = 0;  ///< [ms]
  std::uint8_t reset_baud = 0;   ///< 2: HOSTBAUD may be used
  std::uint8_t gyro_type = 0;
  std::int16_t drift_factor = 0;
  std::uint8_t aux2_baud = 0;
  std::uint8_t aux3_baud = 0;
  std::uint16_t encoder_ticks_per_mm = 0;
  std::uint16_t shutdown_volts = 0;  ///< [0.1 V]
  std::string firmware = {};
  std::uint16_t gyro_clockwise = 0;
  std::uint16_t gyro_counter_clockwise = 0;
  std::uint8_t kinematics_delay = 0;  ///< [ms]
  std::uint16_t lateral_velocity_top = 0;
  std::uint16_t lateral_acceleration_top = 0;
  std::uint16_t lateral_velocity_max = 0;
  std::uint16_t lateral_acceleration = 0;
  std::uint16_t lateral_deceleration = 0;
  std::uint16_t charge_threshold = 0;
  bool operator==(const ConfigPacket&) const = default;
};

/// ENCODERpac. Counts since the controller started; they roll over.
struct EncoderPacket {
  static constexpr PacketType kType = PacketType::kEncoder;
  std::int32_t left = 0;
  std::int32_t right = 0;
  bool operator==(const EncoderPacket&) const = default;
};

/// IOpac.
struct IoPacket {
  static constexpr PacketType kType = PacketType::kIo;
  Bytes digital_inputs;   ///< eight bits a byte
  Bytes digital_outputs;  ///< likewise
  std::vector<std::uint16_t> analogs;
  bool operator==(const IoPacket&) const = default;
};

/// GRIPPERpac.
struct GripperPacket {
  static constexpr PacketType kType = PacketType::kGripper;
  std::uint8_t kind = 0;  ///< 0: none, 1: at the user I/O, 2: at the general I/O
  std::uint8_t state = 0;
  std::uint8_t grasp_time = 0;
  bool operator==(const GripperPacket&) const = default;
};

/// SERAUX: bytes that came on one of the serial lines of the robot.
struct AuxPacket {
  std::uint8_t line = 1;  ///< 1 to 3
  Bytes bytes;
  bool operator==(const AuxPacket&) const = default;
};

/// GYROpac.
struct GyroPacket {
  static constexpr PacketType kType = PacketType::kGyro;
  struct Reading {
    std::uint16_t rate = 512;      ///< centre 512
    std::uint8_t temperature = 0;  ///< counts
    bool operator==(const Reading&) const = default;
  };
  std::vector<Reading> readings;
  bool operator==(const GyroPacket&) const = default;
};

/// JOYpac.
struct JoystickPacket {
  static constexpr PacketType kType = PacketType::kJoystick;
  std::uint8_t button1 = 0;
  std::uint8_t button2 = 0;
  std::uint16_t x = 512;  ///< centre 512, as the others
  std::uint16_t y = 512;
  std::uint16_t throttle = 512;
  bool operator==(const JoystickPacket&) const = default;
};

/// The batteries' own data.
struct BatteryPacket {
  static constexpr PacketType kType = PacketType::kBattery;
  std::uint8_t batteries = 0;
  std::uint8_t bytes_each = 0;
  Bytes data;
  bool operator==(const BatteryPacket&) const = default;
};

/// The camera's blob in one channel (manual 9.2, struct vinfo). Pixels, the image's centre is (0,
/// 0).
struct VisionChannel {
  enum class Mode : std::uint8_t { kBlob = 0, kLine = 1, kBlobWithBox = 2 };
  Mode mode = Mode::kBlob;
  std::int16_t x = 0;  ///< centre of mass; kLine: horizontal centre
  std::int16_t y = 0;
  std::uint16_t area = 0;  ///< 0: no blob
  std::uint16_t height = 0;
  std::uint16_t width = 0;
  std::uint16_t first = 0;  ///< kLine: first row with a segment, from the bottom
  std::uint16_t count = 0;  ///< kLine: rows with segments; 0: no line
  bool operator==(const VisionChannel&) const = default;
};

/// The Fast Track Vision System's packet, ten a second. The manual gives its content (9.2) but not
/// its layout: type and order are ours. For each channel, in the order A, B, C: mode (byte), x, y,
/// area; in kBlobWithBox then height and width; in kLine mode, x, first, count.
struct VisionPacket {
  static constexpr PacketType kType = PacketType::kVision;
  std::array<VisionChannel, 3> channels{};
  bool operator==(const VisionPacket&) const = default;
};

/// One piece of the simulated laser's scan.
struct SimLaserPacket {
  static constexpr PacketType kType = PacketType::kSimLaser;
  std::int16_t x = 0;
  std::int16_t y = 0;
  std::int16_t th = 0;
  std::uint16_t total = 0;
  std::uint16_t first = 0;
  std::vector<std::uint16_t> ranges;
  bool operator==(const SimLaserPacket&) const = default;
};

/// The answer to SIM_STAT.
struct SimStatusPacket {
  static constexpr PacketType kType = PacketType::kSimStatus;
  std::uint32_t flags = 0;
  std::uint16_t sim_interval = 0;   ///< [ms]
  std::uint16_t real_interval = 0;  ///< [ms]
  std::uint16_t last_interval = 0;  ///< [ms]
  std::int32_t true_x = 0;          ///< [mm]
  std::int32_t true_y = 0;
  std::int32_t true_z = 0;
  std::int32_t true_th = 0;   ///< [deg]
  std::int32_t latitude = 0;  ///< [1e-6 deg]
  std::int32_t longitude = 0;
  std::int32_t altitude = 0;  ///< [cm]
  std::int8_t gps = 0;
  std::int32_t odometry_error_x = 0;
  std::int32_t odometry_error_y = 0;
  std::int32_t odometry_error_th = 0;
  bool operator==(const SimStatusPacket&) const = default;
};

/// A packet of a type without a reader here, or of an unknown type.
struct OtherPacket {
  std::uint8_t type = 0;
  Bytes data;
  bool operator==(const OtherPacket&) const = default;
};

using ServerPacket =
    std::variant<InformationPacket, ConfigPacket, EncoderPacket, IoPacket, GripperPacket, AuxPacket,
                 GyroPacket, JoystickPacket, BatteryPacket, VisionPacket, SimLaserPacket,
                 SimStatusPacket, OtherPacket>;

/// Reads a packet's body; OtherPacket for a type that is not one of those above, or a packet that
/// ends too early. (SYNC answers are not for this function: the state of the connection decides
/// about them.)
ServerPacket decode_packet(ByteView body);

/// True where decode_packet reads the fields of this type.
bool is_read(PacketType type);

/// The whole packet (frame included); data that do not fit are left out. AuxPacket's line is
/// clamped to 1 to 3.
Bytes encode(const ServerPacket& packet);

/// The name of the type; empty for a type without one.
std::string_view packet_type_name(std::uint8_t type);

/// The configuration packet of a robot with these parameters. host_baud as HOSTBAUD counts.
ConfigPacket config_of(const RobotParameters& parameters, const std::string& name,
                       const std::string& serial);

}  // namespace saphira::protocol
