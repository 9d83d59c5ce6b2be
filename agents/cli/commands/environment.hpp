#pragma once

#include <map>
#include <string>
#include <vector>

#include "saphira/bus/node.hpp"
#include "saphira/cli/running_bus.hpp"

namespace saphira::cli {

/// The bus options that were given to us, for programs that we start.
std::map<std::string, std::string> as_environment(const bus::NodeOptions& options);

/// The bus that these options name, for commands that name none (FoundBus).
RunningBus bus_of(const std::string& what, const bus::NodeOptions& options);

/// A bus of our own: a robot that nobody else has, and unless one was asked for, a domain at
/// random. name: of the command.
bus::NodeOptions own_bus(bus::NodeOptions options, const std::string& name);

/// Runs the program words[0] in our place. std::system_error where it cannot.
[[noreturn]] void execute(std::vector<std::string> words);

}  // namespace saphira::cli
