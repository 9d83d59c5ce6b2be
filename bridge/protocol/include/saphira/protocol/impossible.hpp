#pragma once

#include <optional>
#include <string>

#include "saphira/protocol/parameters.hpp"
#include "saphira/protocol/server_packet.hpp"

namespace saphira::protocol {

// A servo's pulses, with what servos bear beyond the usual 1000 to 2000.
inline constexpr int kShortestPulse = 400;  ///< [us]
inline constexpr int kLongestPulse = 2600;  ///< [us]

/// A value that a robot with these parameters cannot have meant, though the checksum is
/// right.
struct Impossible {
  std::string what;    ///< in words, with the file where its limits are
  bool whole = false;  ///< nothing in the packet is to be believed
};

/// Looks at each field of a packet. A field that can be left out is taken out of the packet: a
/// reading of a sonar that is not in the table, a servo's width, what ARCOS appends (with all
/// behind it). Any other makes the packet as a whole impossible: a wheel, a turn or a heading
/// beyond what the robot can do, more readings than it can have taken, a packet that ends within
/// its fields.
std::optional<Impossible> take_out_impossible(ServerPacket& packet,
                                              const RobotParameters& parameters);

}  // namespace saphira::protocol
