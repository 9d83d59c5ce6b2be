#pragma once

#include <cstddef>
#include <cstdint>

namespace saphira::bus::internal {

/// How much of a received packet is an RTPS message that holds together: a header and submessages
/// of which each ends within the packet. 0: nothing.
///
/// Fast DDS's own statistics, which it appends to each message, are cut off: it ends the process
/// (an assertion) where they are not quite as it writes them, and nobody here reads them.
std::size_t sound_length(const std::uint8_t* packet, std::size_t size);

}  // namespace saphira::bus::internal
