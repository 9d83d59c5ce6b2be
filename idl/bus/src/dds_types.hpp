#pragma once

#include <fastdds/dds/topic/TypeSupport.hpp>
#include <vector>

namespace saphira::bus::internal {

/// A fresh TypeSupport for each type of the contract.
std::vector<eprosima::fastdds::dds::TypeSupport> all_types();

}  // namespace saphira::bus::internal
