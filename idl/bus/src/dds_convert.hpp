#pragma once

// Values of Fast DDS and ours.

#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/common/InstanceHandle.h>
#include <fastdds/rtps/common/Time_t.h>

#include <algorithm>
#include <cstdint>

#include "saphira/bus/endpoint.hpp"

namespace saphira::bus::internal {

inline eprosima::fastrtps::Duration_t milliseconds(int ms) {
  return {ms / 1000, static_cast<std::uint32_t>(ms % 1000) * 1000000U};
}

/// 0 where it is infinite.
inline double seconds(const eprosima::fastrtps::Duration_t& duration) {
  return duration == eprosima::fastrtps::c_TimeInfinite
             ? 0.0
             : duration.seconds + 1e-9 * static_cast<double>(duration.nanosec);
}

inline WriterId to_id(const eprosima::fastrtps::rtps::GUID_t& guid) {
  WriterId id{};
  std::copy_n(guid.guidPrefix.value, 12, id.begin());
  std::copy_n(guid.entityId.value, 4, id.begin() + 12);
  return id;
}

inline WriterId to_id(const eprosima::fastrtps::rtps::InstanceHandle_t& handle) {
  WriterId id{};
  for (unsigned i = 0; i < id.size(); ++i)
    id[i] = handle.value[i];
  return id;
}

}  // namespace saphira::bus::internal
