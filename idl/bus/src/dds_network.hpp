#pragma once

#include <chrono>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <set>
#include <string>

#include "saphira/bus/node.hpp"

namespace saphira::bus::internal {

/// Silence after which discovery drops a program. Long: one that stood still and comes back before
/// is still matched, while one that was dropped by one side alone may never be heard again by that
/// side (Fast DDS 2.9 keeps the other side's half of the match). That a program has died is noticed
/// by its presence.
constexpr std::chrono::seconds kLease{60};

/// The IPv4 addresses of this machine that a participant would use now.
std::set<std::string> own_addresses();

/// Settings of Fast DDS as a whole, before the first participant.
void set_up_library();

/// How a program finds others and by which addresses. std::runtime_error where a peer or the
/// interface is not to be had.
eprosima::fastdds::dds::DomainParticipantQos participant_qos(const NodeOptions& options);

}  // namespace saphira::bus::internal
