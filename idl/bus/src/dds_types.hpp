#pragma once

#include <fastdds/dds/topic/TypeSupport.hpp>
#include <vector>

namespace saphira::bus::internal {

/// A fresh TypeSupport for each type of the contract.
std::vector<eprosima::fastdds::dds::TypeSupport> all_types();

/// True where the newest sample that this thread took since the last call is not of its type. Such
/// a sample must not be used.
bool take_malformed();

}  // namespace saphira::bus::internal
