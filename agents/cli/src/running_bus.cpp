#include "saphira/cli/running_bus.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace saphira::cli {

std::string to_text(const RunningBus& bus) {
  return nlohmann::json{{"what", bus.what},
                        {"robot", bus.robot},
                        {"domain", bus.domain},
                        {"profile", bus.profile},
                        {"peers", bus.peers},
                        {"interface", bus.interface},
                        {"deployment", bus.deployment}}
             .dump() +
         "\n";
}

std::optional<RunningBus> parse_running_bus(std::string_view text) {
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    return RunningBus{json.at("what"),      json.at("robot"), json.at("domain"),
                      json.at("profile"),   json.at("peers"), json.at("interface"),
                      json.at("deployment")};
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

const RunningBus* bus_meant(const RunningBus& usual, const std::vector<RunningBus>& running) {
  if (running.empty())
    return nullptr;
  for (const RunningBus& bus : running)
    if (options_of(bus, usual).empty())
      return nullptr;
  // A real robot comes before a demonstration beside it.
  const auto found = std::find_if(running.begin(), running.end(),
                                  [](const RunningBus& bus) { return bus.deployment; });
  return found == running.end() ? &running.front() : &*found;
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
  return options;
}

}  // namespace saphira::cli
