#pragma once

#include <string>
#include <vector>

#include "saphira/bus/node.hpp"
#include "saphira/cli/deployment.hpp"

namespace saphira::cli {

/// Runs the programs dry, one after the other. Returns the words of the first that refuses its
/// options; empty: none does. Nothing is started.
std::string refusal(const Deployment& deployment, const Places& places,
                    const std::vector<std::string>& set, const bus::NodeOptions& options);

}  // namespace saphira::cli
