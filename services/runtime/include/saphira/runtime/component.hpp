#pragma once

#include <functional>
#include <string>

#include "saphira/command_line/command_line.hpp"
#include "saphira/runtime/shell.hpp"

namespace saphira::runtime {

/// A service as a part of the system: the data to offer, start and list it.
struct Component {
  std::string name;    ///< on the bus; its program is saphira-NAME
  std::string effect;  ///< its purpose, in one line
  /// Adds its options to a command line; `make` uses their values. Empty: no options.
  std::function<void(CommandLine&)> add_options;
  Shell::Make make;
};

/// The topics that a component reads and writes, found by making it on a private bus, without
/// starting it.
std::vector<Port> ports_of(const Component& component);

/// The main() of a component's program (bus::run_program).
int run_component(int argc, char** argv, const Component& component);

}  // namespace saphira::runtime
