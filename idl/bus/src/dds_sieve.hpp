#pragma once

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>

#include <atomic>
#include <memory>
#include <utility>

namespace saphira::bus::internal {

/// What stands between the network and Fast DDS, which takes a packet in a thread of its own and
/// ends the process where it throws: only sound messages pass, and what is thrown at one is caught.
struct SieveDescriptor : eprosima::fastdds::rtps::ChainingTransportDescriptor {
  using Mute = std::shared_ptr<const std::atomic<bool>>;

  /// While `mute` is set nothing is sent.
  SieveDescriptor(std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> low,
                  Mute the_mute)
      : ChainingTransportDescriptor(std::move(low)), mute(std::move(the_mute)) {}
  eprosima::fastdds::rtps::TransportInterface* create_transport() const override;

  Mute mute;
};

}  // namespace saphira::bus::internal
