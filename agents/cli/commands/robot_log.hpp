#pragma once

#include "commands.hpp"

namespace saphira::cli {

/// Subcommands of `saphira log` for logs of real robots.
void add_robot_log(CLI::App& log, Chosen& chosen);

}  // namespace saphira::cli
