#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace saphira::cli {

/// The bus of programs that run on this machine.
struct RunningBus {
  std::string what;  ///< its owner: "the demo", "the deployment laptop"
  std::string robot;
  std::uint32_t domain = 0;
  std::string profile = "host";
  std::vector<std::string> peers;
  std::string interface;
  bool deployment = false;  ///< of `saphira up`, not of a demonstration
};

/// The form in files. An incomplete text reads as nothing.
std::string to_text(const RunningBus& bus);
std::optional<RunningBus> parse_running_bus(std::string_view text);

/// The bus that a command without bus options joins. `running`: newest first. The usual bus if it
/// runs or no bus runs (nullptr), otherwise the newest deployment, else the newest.
const RunningBus* bus_meant(const RunningBus& usual, const std::vector<RunningBus>& running);

/// The options to join it, without defaults.
std::string options_of(const RunningBus& bus, const RunningBus& usual);

}  // namespace saphira::cli
