#pragma once

#include <map>
#include <string>

#include "saphira/bus/node.hpp"

namespace saphira::cli {

/// The bus options that were given to us, for programs that we start.
std::map<std::string, std::string> as_environment(const bus::NodeOptions& options);

}  // namespace saphira::cli
