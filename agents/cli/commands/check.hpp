#pragma once

#include <string>
#include <vector>

#include "saphira/bus/node.hpp"
#include "saphira/cli/deployment.hpp"

namespace saphira::cli {

/// Runs each program dry, until one does not take what the deployment gives it: the words for that,
/// with the program's own. Empty: all take it. Nothing is started.
std::string refusal(const Deployment& deployment, const Places& places,
                    const std::vector<std::string>& set, const bus::NodeOptions& options);

}  // namespace saphira::cli
