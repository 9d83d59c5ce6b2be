#include "saphira/cli/running_bus.hpp"

#include "saphira/bus/node.hpp"

namespace saphira::cli {

std::optional<RunningBus> bus_meant(const RunningBus& usual, const std::vector<RunningBus>& running,
                                    const GivenOptions& given) {
  // A network alone is given for a robot that runs elsewhere.
  if (given.network && !given.robot && !given.domain)
    return std::nullopt;
  std::optional<RunningBus> meant;
  for (RunningBus bus : running) {
    if ((given.robot && bus.robot != usual.robot) || (given.domain && bus.domain != usual.domain))
      continue;
    if (given.network) {
      bus.profile = usual.profile;
      bus.peers = usual.peers;
      bus.interface = usual.interface;
    }
    // A person's own credentials come before those of a service.
    if (given.security || bus.security.empty() ||
        (bus.security != bus::kOpenBus && usual.security != bus::kOpenBus))
      bus.security = usual.security;
    if (options_of(bus, usual).empty())
      return std::nullopt;
    // A real robot comes before a demonstration beside it.
    if (!meant || (bus.deployment && !meant->deployment))
      meant = std::move(bus);
  }
  return meant;
}

std::string options_of(const RunningBus& bus, const RunningBus& usual) {
  std::string options;
  const auto add = [&](const std::string& name, const std::string& value) {
    options += (options.empty() ? "" : " ") + name + " " + value;
  };
  if (bus.robot != usual.robot)
    add("--robot", bus.robot);
  if (bus.domain != usual.domain)
    add("--domain", std::to_string(bus.domain));
  if (bus.profile != usual.profile)
    add("--profile", bus.profile);
  if (bus.peers != usual.peers)
    for (const std::string& peer : bus.peers)
      add("--peer", peer);
  if (bus.interface != usual.interface && !bus.interface.empty())
    add("--interface", bus.interface);
  if (bus.security != usual.security)
    add("--security", bus.security);
  return options;
}

}  // namespace saphira::cli
