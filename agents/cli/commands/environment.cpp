#include "environment.hpp"

#include "watch.hpp"

namespace saphira::cli {

std::map<std::string, std::string> as_environment(const bus::NodeOptions& options) {
  std::string peers;
  for (const std::string& peer : options.peers)
    peers += (peers.empty() ? "" : ",") + peer;
  return {{"SAPHIRA_ROBOT", options.robot},
          {"SAPHIRA_DOMAIN", std::to_string(options.domain)},
          {"SAPHIRA_PROFILE", name_of(options.profile)},
          {"SAPHIRA_PEERS", peers},
          {"SAPHIRA_INTERFACE", options.interface},
          {"SAPHIRA_SECURITY", options.security.empty() ? bus::kOpenBus : options.security}};
}

}  // namespace saphira::cli
