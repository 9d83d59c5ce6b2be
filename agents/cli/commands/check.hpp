#pragma once

#include <string>
#include <vector>

#include "saphira/bus/node.hpp"
#include "saphira/cli/deployment.hpp"

namespace saphira::cli {

/// The result of a shell command: success, and the output.
struct Said {
  bool well = true;
  bool misused = false;  ///< `saphira up` ends for that
  std::string text;
};
Said said_by(const std::string& command);

/// Runs the programs dry, one after the other. Returns the words of the first that refuses its
/// options; empty: none does. Nothing is started.
std::string refusal(const Deployment& deployment, const Places& places,
                    const std::vector<std::string>& set, const bus::NodeOptions& options);

}  // namespace saphira::cli
