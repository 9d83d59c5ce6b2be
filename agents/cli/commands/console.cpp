#include <cstdlib>
#include <iostream>
#include <utility>

#include "commands.hpp"
#include "environment.hpp"
#include "run_folder.hpp"
#include "saphira/base/places.hpp"

namespace saphira::cli {

namespace {

/// Replaces this process by another program, with the bus options given here.
int become(const std::string& program, const bus::NodeOptions& options,
           const std::vector<std::string>& arguments) {
  for (const auto& [name, value] : as_environment(options))
    if (!value.empty())
      setenv(name.c_str(), value.c_str(), 1);
  std::vector<std::string> words{program_folder() + "/" + program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  execute(std::move(words));
}

/// A file's name is its time and the event: 2026-05-04-101530-goal-failed.mcap.
int box(const FilesOf& bus) {
  const std::vector<std::string> files = box_files(bus);
  if (files.empty())
    return failed("nothing is kept yet" + words_of(bus) +
                  ": saphira up keeps the last minute after a stop, a failed goal, or the "
                  "loss of a program, the robot or its place");
  for (const std::string& file : files)
    std::cout << file << '\n';
  return bus::kExitOk;
}

}  // namespace

/// The commands that are separate programs, with their own options and help.
void add_programs(CLI::App& app, Chosen& chosen) {
  for (const auto& [name, summary] :
       {std::pair("console",
                  "See the robot think and drive it, in a browser; or --screenshot FILE"),
        {"mcp", "Let a language model send the robot (Model Context Protocol)"},
        {"record", "Record the bus as an MCAP file"},
        {"replay", "Play a recording on the bus, as another robot"},
        {"foxglove", "See the robot in Foxglove or Lichtblick"},
        {"ros2", "Show the robot to ROS 2, and let ROS 2 drive it"}}) {
    CLI::App* command = app.add_subcommand(name, summary);
    command->allow_extras();
    command->set_help_flag();
    command->callback([command, &chosen] {
      chosen.run = [program = "saphira-" + command->get_name(), rest = command->remaining()](
                       const bus::NodeOptions& options, const bus::Stop&) {
        return become(program, options, rest);
      };
    });
  }
}

void add_box(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand(
      "box", "The recordings of the last minute after an event, the newest first");
  chosen.apart.insert(command);
  chosen.when(command,
              [&app](const bus::NodeOptions&, const bus::Stop&) { return box(given_bus(app)); });
}

}  // namespace saphira::cli
