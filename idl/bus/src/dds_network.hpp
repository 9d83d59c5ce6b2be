#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <memory>
#include <set>
#include <string>

#include "dds_guard.hpp"
#include "machines.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::bus::internal {

/// Silence after which discovery drops a program. Long: one that stood still and comes back before
/// is still matched, while one that was dropped by one side alone may never be heard again by that
/// side (Fast DDS 2.9 keeps the other side's half of the match). That a program has died is noticed
/// by its presence.
constexpr std::chrono::seconds kLease{60};

/// wan: how many programs of one machine can be found by a peer that knows nothing but its address.
/// Each announces itself to so many places on each peer.
constexpr std::uint32_t kProgramsPerPeer = 20;

/// The IPv4 addresses of this machine that a participant would use now.
std::set<std::string> own_addresses();

/// Settings of Fast DDS as a whole, before the first participant.
void set_up_library();

/// How a program finds others and by which addresses. std::runtime_error where a peer or the
/// interface is not to be had. While `mute` is set it sends nothing. `machines`, `guard`: see
/// SieveDescriptor.
eprosima::fastdds::dds::DomainParticipantQos participant_qos(
    const NodeOptions& options, std::shared_ptr<const std::atomic<bool>> mute,
    std::shared_ptr<Machines> machines = nullptr, std::shared_ptr<Guard> guard = nullptr);

/// The user data of a participant: its host, its process, and the machines that it hears.
eprosima::fastdds::dds::UserDataQosPolicy user_data(const std::string& heard);

/// The addresses of the peers that the options name; std::runtime_error as above.
std::set<std::string> peer_addresses(const NodeOptions& options);

}  // namespace saphira::bus::internal
