#pragma once

#include <map>
#include <string>
#include <vector>

#include "saphira/bus/node.hpp"
#include "saphira/cli/running_bus.hpp"

namespace saphira::cli {

/// Our bus options, for programs that we start.
std::map<std::string, std::string> as_environment(const bus::NodeOptions& options);

/// The bus of these options, for other commands (FoundBus).
RunningBus bus_of(const std::string& what, const bus::NodeOptions& options);

/// The options of a program on this bus.
bus::NodeOptions on_bus(const RunningBus& bus, bus::NodeOptions options);

/// A private bus: a robot name of its own, and unless a domain was given, a random one. name: of
/// the command.
bus::NodeOptions own_bus(bus::NodeOptions options, const std::string& name);

/// Runs the program words[0] in our place. std::system_error where it cannot.
[[noreturn]] void execute(std::vector<std::string> words);

}  // namespace saphira::cli
