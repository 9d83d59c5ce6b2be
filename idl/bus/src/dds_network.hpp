#pragma once

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "saphira/bus/node.hpp"

namespace saphira::bus::internal {

/// Settings of Fast DDS as a whole, before the first participant.
void set_up_library();

/// How a program finds others and by which addresses. std::runtime_error where a peer or the
/// interface is not to be had.
eprosima::fastdds::dds::DomainParticipantQos participant_qos(const NodeOptions& options);

}  // namespace saphira::bus::internal
