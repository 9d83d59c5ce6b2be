#pragma once

// The QoS settings that readers and writers have in common.

#include <fastdds/dds/core/policy/QosPolicies.hpp>

#include "dds_convert.hpp"
#include "internal.hpp"

namespace saphira::bus::internal {

template <class Q>
void set_common_qos(Q& qos, const Policies& policies, int depth) {
  namespace fdds = eprosima::fastdds::dds;
  qos.reliability().kind =
      policies.reliable ? fdds::RELIABLE_RELIABILITY_QOS : fdds::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind = policies.transient_local ? fdds::TRANSIENT_LOCAL_DURABILITY_QOS
                                                   : fdds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fdds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = depth;
  // 0 is infinite. The default of ten instances makes the eleventh key's write fail.
  qos.resource_limits().max_samples = 0;
  qos.resource_limits().max_instances = 0;
  qos.resource_limits().max_samples_per_instance = 0;
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::DYNAMIC_REUSABLE_MEMORY_MODE;
  // AUTO would leave files in /dev/shm after a kill, even with UDP as the only transport.
  qos.data_sharing().off();
}

}  // namespace saphira::bus::internal
