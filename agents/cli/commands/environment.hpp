#pragma once

#include <map>
#include <string>

#include "saphira/bus/node.hpp"

namespace saphira::cli {

/// The bus options that were given to us, for programs that we start.
std::map<std::string, std::string> as_environment(const bus::NodeOptions& options);

/// A bus of our own: a robot that nobody else has, and unless one was asked for, a domain at
/// random. name: of the command.
bus::NodeOptions own_bus(bus::NodeOptions options, const std::string& name);

}  // namespace saphira::cli
