#include "namesakes.hpp"

namespace saphira::bridge {

Namesakes::Namesakes(bus::Node& node) : node_(node), statuses_(node.reader(bus::topics::kStatus)) {}

void Namesakes::take() {
  for (const auto& sample : statuses_.take()) {
    const v1::ServiceStatus& other = sample.data;
    if (other.name() != node_.status().name() || other.instance() == node_.status().instance())
      continue;
    const bool serves = !sample.info.disposed && (other.state() == v1::SERVICE_RUNNING ||
                                                  other.state() == v1::SERVICE_DEGRADED);
    if (!serves) {
      others_.erase(sample.info.writer);
      continue;
    }
    const auto [known, is_new] = others_.try_emplace(
        sample.info.writer, "process " + std::to_string(other.pid()) + " at " + other.host());
    if (is_new)
      node_.error("another bridge, " + known->second + ", has a robot of the name \"" +
                  node_.options().robot + "\": give one of them another name (--robot)");
  }
  for (const bus::WriterId& writer : statuses_.take_lost())
    others_.erase(writer);
}

}  // namespace saphira::bridge
