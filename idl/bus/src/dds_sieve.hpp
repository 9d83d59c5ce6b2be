#pragma once

#include <fastdds/rtps/common/Locator.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "dds_guard.hpp"
#include "entrance.hpp"
#include "fleet.hpp"
#include "machines.hpp"

namespace saphira::bus::internal {

/// A filter between the network and Fast DDS: only sound messages pass, and exceptions are caught.
/// Fast DDS takes a packet in its own thread, where an exception would end the process.
struct SieveDescriptor : eprosima::fastdds::rtps::ChainingTransportDescriptor {
  using Mute = std::shared_ptr<const std::atomic<bool>>;
  /// True where a packet is to be dropped, by its sender's GUID prefix and address.
  using Ignore = std::function<bool(const std::uint8_t* prefix,
                                    const eprosima::fastrtps::rtps::Locator_t& from)>;

  /// While `mute` is set nothing is sent. `machines`, if any, get the sources of announcements; the
  /// program announces itself to them, at each of these ports. With a `guard`, packets from senders
  /// with a revoked certificate are dropped, and so are farewells and introductions in another's
  /// name, which anybody can forge; the `entrance` decides which introductions pass.
  /// Announcements of programs that the `fleet` does not meet are dropped.
  SieveDescriptor(std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> low,
                  Mute the_mute, std::shared_ptr<Machines> the_machines = nullptr,
                  std::vector<std::uint32_t> the_ports = {},
                  std::shared_ptr<Guard> the_guard = nullptr,
                  std::shared_ptr<Entrance> the_entrance = nullptr, Ignore the_ignore = nullptr,
                  Fleet the_fleet = Fleet({}))
      : ChainingTransportDescriptor(std::move(low)),
        mute(std::move(the_mute)),
        machines(std::move(the_machines)),
        ports(std::move(the_ports)),
        guard(std::move(the_guard)),
        entrance(std::move(the_entrance)),
        ignore(std::move(the_ignore)),
        fleet(std::move(the_fleet)) {}
  eprosima::fastdds::rtps::TransportInterface* create_transport() const override;

  Mute mute;
  std::shared_ptr<Machines> machines;
  std::vector<std::uint32_t> ports;
  std::shared_ptr<Guard> guard;
  std::shared_ptr<Entrance> entrance;  ///< one with a guard
  Ignore ignore;
  Fleet fleet;
};

}  // namespace saphira::bus::internal
