#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <memory>
#include <string>

#include "addresses.hpp"
#include "dds_guard.hpp"
#include "entrance.hpp"
#include "fleet.hpp"
#include "machines.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::bus::internal {

/// The silence after which discovery drops a program. It is long: a program that stood still and
/// comes back before is still matched, while a program that was dropped by one side alone may never
/// be heard again by that side (Fast DDS 2.9 keeps the other side's half of the match). The death
/// of a program is noticed by its presence.
constexpr std::chrono::seconds kLease{60};

/// wan: number of programs of one machine that a peer can find by its address alone. Each program
/// announces itself to this number of places on each peer.
constexpr std::uint32_t kProgramsPerPeer = 20;

/// A program has two sides on the bus, each with a participant of its own: programs of this machine
/// reach each other by loopback whatever becomes of the network.
enum class Side : std::size_t { local, network };

/// IPv4 addresses of interfaces that are up and running, without loopback.
Addresses::Devices network_addresses();

/// True where a text is an IPv4 address, and no name.
bool is_address(const std::string& text);
/// The address of a host by its name [empty: not known]. May take seconds.
std::string look_up(const std::string& host);

/// Settings of Fast DDS as a whole, before the first participant.
void set_up_library();

/// The discovery settings and addresses of one side. While `mute` is set the side sends nothing.
/// `machines`, `guard`, `entrance`, `fleet`: see SieveDescriptor.
eprosima::fastdds::dds::DomainParticipantQos participant_qos(
    const NodeOptions& options, Side side, std::shared_ptr<const std::atomic<bool>> mute,
    std::shared_ptr<Machines> machines, std::shared_ptr<Guard> guard,
    std::shared_ptr<Entrance> entrance, const Fleet& fleet);

/// The user data of a participant: its host, its process and program, its robot (Fleet), and the
/// machines that it hears.
eprosima::fastdds::dds::UserDataQosPolicy user_data(const NodeOptions& options,
                                                    const std::string& heard);

}  // namespace saphira::bus::internal
