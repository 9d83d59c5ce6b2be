#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace saphira::cli {

/// The bus of programs that run on this machine.
struct RunningBus {
  std::string what;  ///< whose it is: "the demo", "the deployment laptop"
  std::string robot;
  std::uint32_t domain = 0;
  std::string profile = "host";
  std::vector<std::string> peers;
  std::string interface;
  bool deployment = false;  ///< of `saphira up`, not of a demonstration
};

/// As files keep it. A text that is not whole is none.
std::string to_text(const RunningBus& bus);
std::optional<RunningBus> parse_running_bus(std::string_view text);

/// The bus that a command joins without options. `running`: newest first. It is the usual one where
/// that runs or nothing does (nullptr), otherwise the newest deployment, else the newest.
const RunningBus* bus_meant(const RunningBus& usual, const std::vector<RunningBus>& running);

/// The options by which a program joins it, without those that are usual anyway.
std::string options_of(const RunningBus& bus, const RunningBus& usual);

}  // namespace saphira::cli
