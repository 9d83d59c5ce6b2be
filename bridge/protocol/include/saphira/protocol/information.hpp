#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "saphira/protocol/packet.hpp"
#include "saphira/protocol/parameters.hpp"

namespace saphira::protocol {

/// The low digit of the packet's first byte, 0x3S. sfSTATUSNOPOWER, sfSTATUSSTOPPED,
/// sfSTATUSMOVING.
enum class Motors : std::uint8_t { kNoPower = 1, kStopped = 2, kMoving = 3 };

/// A range of this or more means: no echo (manual 6.3.2).
inline constexpr double kNoEcho = 5.0;  // [m]

struct RawSonar {
  std::uint8_t number = 0;
  std::uint16_t range = 0;
  bool operator==(const RawSonar&) const = default;
};

/// The fields that ARCOS appends. A packet may end behind any of them; the rest is missing then.
struct TrailingFields {
  std::optional<std::uint16_t> battery;         ///< [0.1 V]
  std::optional<std::uint8_t> charge_state;     ///< the charger's; 0: not charging
  std::optional<std::int16_t> rotation;         ///< [0.1 deg/s]
  std::optional<std::uint16_t> faults;          ///< bits, the robot's
  std::optional<std::int16_t> lateral;          ///< [mm/s] sideways
  std::optional<std::int8_t> temperature;       ///< [deg C]; -127 and -128: unknown
  std::optional<std::uint8_t> state_of_charge;  ///< [%]; 0: unknown
  std::optional<std::uint32_t> time;            ///< [us] of the controller, rolls over
  std::optional<std::uint32_t> flags3;
  bool operator==(const TrailingFields&) const = default;
};

/// The information packet of manual Table 5-5 in the units of the packet. (The table's second
/// "Bumpers" row is not a field: every client and server has one stall field of two bytes.)
struct InformationPacket {
  Motors motors = Motors::kStopped;
  std::uint16_t x = 0;  ///< 15 bits, rolls over
  std::uint16_t y = 0;  ///< 15 bits, rolls over
  std::int16_t th = 0;
  std::int16_t left_velocity = 0;
  std::int16_t right_velocity = 0;
  std::uint8_t battery = 0;           ///< [0.1 V]
  std::uint8_t left_stall = 0;        ///< P2OS, ARCOS: bit 0 the stall, the others the rear bumpers
  std::uint8_t right_stall = 0;       ///< likewise, the front bumpers
  std::int16_t control = 0;           ///< the server's heading setpoint
  std::uint16_t ptu = 0;              ///< ARCOS: flags; see kFlagMotors and the others
  std::uint8_t say = 0;               ///< P2OS, ARCOS: the compass [2 deg]
  std::vector<RawSonar> sonars = {};  ///< the new readings, in the order of firing
  // Some servers omit the fields behind the sonars: 0 then.
  std::uint16_t timer = 0;  ///< P2OS, ARCOS: the gripper's bits in the high byte
  std::uint8_t analog = 0;
  std::uint8_t digital_input = 0;
  std::uint8_t digital_output = 0;
  TrailingFields trailing = {};
  std::size_t unknown_bytes = 0;  ///< behind all that; not written by encode

  bool operator==(const InformationPacket&) const = default;
};

// Bits of ARCOS's flags, in the place of `ptu`.
inline constexpr unsigned kFlagMotors = 1U << 0U;
inline constexpr unsigned kFlagSonars = 0xFU << 1U;  ///< a bit for each array
inline constexpr unsigned kFlagEmergencyStop = 1U << 5U;

/// Sonar readings beyond this many do not fit into a packet; encode leaves them out. With trailing
/// fields, six fewer at the most.
inline constexpr std::size_t kMaxSonarsInPacket = (kMaxBody - 25) / 3;

/// By the first byte of its body.
bool is_information(std::uint8_t type);

/// The whole packet (frame included).
Bytes encode(const InformationPacket& packet);

/// Reads a packet's body. Bytes behind the known fields are counted and skipped. Nothing for
/// another packet, or one that ends before its sonar readings do.
std::optional<InformationPacket> decode_information(ByteView body);

struct Sonar {
  std::uint8_t number = 0;
  double range = 0.0;  ///< [m]
  bool echo = false;
};

/// The same in SI units.
struct Information {
  Motors motors = Motors::kStopped;
  double th = 0.0;                 ///< [rad] in (-pi, pi], of the server's own coordinates
  double left_velocity = 0.0;      ///< [m/s]
  double right_velocity = 0.0;     ///< [m/s]
  double velocity = 0.0;           ///< [m/s] of the middle
  double rotation_velocity = 0.0;  ///< [rad/s]
  double battery = 0.0;            ///< [V]
  bool left_stalled = false;
  bool right_stalled = false;
  std::uint16_t bumpers = 0;  ///< both stall bytes as they came, the left one low
  double control = 0.0;       ///< [rad] in (-pi, pi], the server's heading setpoint
  double head = 0.0;          ///< [rad] the direction of the cameras, by ptu
  std::uint16_t ptu = 0;      ///< [us]
  std::uint8_t say = 0;
  std::vector<Sonar> sonars;
  std::uint16_t timer = 0;
  std::uint8_t analog = 0;
  std::uint8_t digital_input = 0;
  std::uint8_t digital_output = 0;

  // From later servers; nothing where the robot's does not report it.
  std::uint8_t front_bumpers = 0;  ///< bit 0 the first switch from the left
  std::uint8_t rear_bumpers = 0;   ///< likewise
  std::optional<bool> motors_on;
  std::optional<bool> emergency_stop;
  std::optional<double> compass;  ///< [rad] (-pi, pi], as the compass counts
  std::uint8_t gripper_bits = 0;  ///< clients disagree on their meaning; as they came
  std::optional<std::uint8_t> charge_state;
  std::optional<double> state_of_charge;   ///< [1] 0 to 1
  std::optional<double> lateral_velocity;  ///< [m/s]
  std::optional<double> temperature;       ///< [deg C]
  std::optional<std::uint16_t> faults;
};

/// Everything but the position, which rolls over: see position_difference.
Information interpret(const InformationPacket& packet, const RobotParameters& parameters);

/// The way from one 15-bit coordinate to the next, in counts, the short way round. Correct if the
/// robot moved less than half the range (0.8 m on a Pioneer 1) between the two.
int position_difference(std::uint16_t from, std::uint16_t to);

}  // namespace saphira::protocol
