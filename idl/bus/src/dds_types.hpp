#pragma once

#include <fastdds/dds/topic/TypeSupport.hpp>
#include <vector>

namespace saphira::bus::internal {

/// A fresh TypeSupport for each type of the contract.
std::vector<eprosima::fastdds::dds::TypeSupport> all_types();

/// True where the sample that this thread took last, since the last call, is none of its type.
/// Nothing of it may be used.
bool take_malformed();

}  // namespace saphira::bus::internal
