#pragma once

#include <optional>
#include <string>

#include "saphira/protocol/parameters.hpp"
#include "saphira/protocol/server_packet.hpp"

namespace saphira::protocol {

/// A value that is impossible for a robot with these parameters, in spite of a right checksum.
struct Impossible {
  std::string what;    ///< in words, with the file where its limits are
  bool whole = false;  ///< no field of the packet is believed
};

/// Checks each field of a packet. A field that the packet can do without is removed: a reading of a
/// sonar that is not in the table, a servo's width, ARCOS's appended fields (with all behind it).
/// Any other makes the whole packet impossible: a wheel, a turn or a heading beyond the robot's
/// limits, more readings than it can have taken, a packet that ends within its fields.
std::optional<Impossible> take_out_impossible(ServerPacket& packet,
                                              const RobotParameters& parameters);

}  // namespace saphira::protocol
