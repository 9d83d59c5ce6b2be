#pragma once

#include "commands.hpp"

namespace saphira::cli {

/// Subcommands of `saphira log` for logs that robots have written.
void add_robot_log(CLI::App& log, Chosen& chosen);

}  // namespace saphira::cli
