#pragma once

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>

#include <memory>

namespace saphira::bus::internal {

/// What stands between the network and Fast DDS, which takes a packet in a thread of its own and
/// ends the process where it throws: only sound messages pass, and what is thrown at one is caught.
struct SieveDescriptor : eprosima::fastdds::rtps::ChainingTransportDescriptor {
  using ChainingTransportDescriptor::ChainingTransportDescriptor;
  eprosima::fastdds::rtps::TransportInterface* create_transport() const override;
};

}  // namespace saphira::bus::internal
