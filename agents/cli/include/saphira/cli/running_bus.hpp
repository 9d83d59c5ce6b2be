#pragma once

#include <cstdint>
#include <optional>
#include <string>
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
  bool deployment = false;    ///< of `saphira up`, not of a demonstration
  std::string security = {};  ///< folder of credentials, or "none"; empty: unknown
};

/// The bus options that a person gave.
struct GivenOptions {
  bool robot = false;
  bool domain = false;
  bool network = false;  ///< profile, peers or interface
  bool security = false;
};

/// The bus that a command joins. `usual`: its own options; `running`: newest first. A given robot
/// or domain selects among these. Of several the usual bus comes first, then the newest deployment,
/// then the newest. Given options stay; the running bus sets the others. None: `usual` stays as it
/// is.
std::optional<RunningBus> bus_meant(const RunningBus& usual, const std::vector<RunningBus>& running,
                                    const GivenOptions& given = {});

/// The options to join it, without defaults.
std::string options_of(const RunningBus& bus, const RunningBus& usual);

}  // namespace saphira::cli
