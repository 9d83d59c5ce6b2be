#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "saphira/bus/node.hpp"
#include "saphira/bus/program.hpp"

/// The subcommands of `saphira`. Each adds itself to the command line, and when it is chosen says
/// what to run.
namespace saphira::cli {

/// What was chosen; set by the callback of a subcommand.
struct Chosen {
  std::function<int(const bus::NodeOptions&, const bus::Stop&)> run;
};

void add_demo(CLI::App& app, Chosen& chosen);
void add_up(CLI::App& app, Chosen& chosen);
void add_status(CLI::App& app, Chosen& chosen);
void add_list(CLI::App& app, Chosen& chosen);
void add_echo(CLI::App& app, Chosen& chosen);
void add_log(CLI::App& app, Chosen& chosen);
void add_goal(CLI::App& app, Chosen& chosen);
void add_intentions(CLI::App& app, Chosen& chosen);
void add_behaviors(CLI::App& app, Chosen& chosen);
void add_why(CLI::App& app, Chosen& chosen);
void add_beliefs(CLI::App& app, Chosen& chosen);
void add_processes(CLI::App& app, Chosen& chosen);
void add_device(CLI::App& app, Chosen& chosen);
void add_map(CLI::App& app, Chosen& chosen);
void add_drive(CLI::App& app, Chosen& chosen);
void add_estop(CLI::App& app, Chosen& chosen);
void add_wiring(CLI::App& app, Chosen& chosen);
void add_bench(CLI::App& app, Chosen& chosen);

}  // namespace saphira::cli
