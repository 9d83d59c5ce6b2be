#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "commands.hpp"
#include "environment.hpp"
#include "run_folder.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/robot_name.hpp"
#include "saphira/cli/printer.hpp"
#include "saphira/situation/words.hpp"
#include "watch.hpp"

namespace saphira::cli {
namespace {

/// In the order of the help.
constexpr AddCommand* kCommands[]{
    add_demo,     add_scenario,  add_up,    add_check,      add_stop,      add_renew,
    add_programs, add_security,  add_keys,  add_audit,      add_box,       add_estop,
    add_status,   add_doctor,    add_goal,  add_intentions, add_behaviors, add_why,
    add_beliefs,  add_processes, add_say,   add_talk,       add_knows,     add_ask,
    add_agents,   add_map,       add_drive, add_direct,     add_device,    add_list,
    add_echo,     add_write,     add_log,   add_wiring,     add_bench,     add_complete};

int print_help(const CLI::App& root, const std::string& name) {
  std::vector<std::string> names;
  for (const CLI::App* const command : root.get_subcommands({})) {
    names.push_back(command->get_name());
    if (command->get_name() != name)
      continue;
    if (command->get_help_ptr() == nullptr)  // a separate program
      execute({program_folder() + "/saphira-" + name, "--help"});
    std::fputs(command->help(root.get_name()).c_str(), stdout);
    return bus::kExitOk;
  }
  std::fprintf(stderr, "saphira: no command \"%s\"%s\n", name.c_str(),
               did_you_mean(name, names, "; `saphira help` lists them").c_str());
  return bus::kExitUsage;
}

/// The name of the robot, or "*" for every robot.
std::string trouble_of_robots(std::string& name) {
  return name == kEveryRobot ? std::string() : trouble_of_robot(name);
}

/// std::invalid_argument: this command does not reach every robot.
void expect_one_robot(const CLI::App& root, const Chosen& chosen) {
  const auto commands = root.get_subcommands();
  if (commands.empty())
    return;
  const auto found = chosen.reach.find(commands.front());
  if (found != chosen.reach.end() && found->second.now())
    return;
  std::vector<std::string> names;
  for (const CLI::App* const command : root.get_subcommands({}))
    if (const auto known = chosen.reach.find(command);
        known != chosen.reach.end() && !known->second.name.empty())
      names.push_back(known->second.name);
  throw std::invalid_argument("every robot (*) is reached by " + situation::listed(names) +
                              " alone: --robot NAME; saphira list names them");
}

/// A command joins a running bus of this machine, as far as its options leave that open.
bus::NodeOptions with_running_bus(const CLI::App& root, const Chosen& chosen,
                                  bus::NodeOptions options) {
  const auto commands = root.get_subcommands();
  if (commands.empty() || chosen.apart.contains(commands.front()))
    return options;
  const auto given = [&](const char* option) { return root.get_option(option)->count() > 0; };
  const RunningBus usual = bus_of("", options);
  std::vector<RunningBus> running = running_buses();
  if (options.robot == kEveryRobot)
    for (RunningBus& each : running)
      each.robot = kEveryRobot;
  const std::optional<RunningBus> meant = bus_meant(
      usual, running,
      {given("--robot"), given("--domain"),
       given("--profile") || given("--peer") || given("--interface"), given("--security")});
  if (!meant)
    return options;
  if (commands.front()->get_name() != "complete")
    complain("saphira: of %s that runs here (%s)\n", meant->what.c_str(),
             options_of(*meant, usual).c_str());
  return on_bus(*meant, options);
}

}  // namespace
}  // namespace saphira::cli

int main(int argc, char** argv) {
  using namespace saphira;
  cli::Chosen chosen;
  CLI::App* root = nullptr;
  std::string about;
  return bus::run_program(
      argc, argv, "cli", "Runs, watches and drives a robot on the Saphira bus",
      [&](CommandLine& line) {
        CLI::App& app = line.parser();
        root = &app;
        app.name("saphira");
        app.require_subcommand(0, 1);
        app.remove_option(app.get_option("--dry-run"));  // saphira check has that
        CLI::Option& robot = *app.get_option("--robot");
        robot.description(
            "The robot to belong to; '*': every robot, where the command reaches all");
        *robot.get_validator(0) = CLI::Validator(cli::trouble_of_robots, "");
        for (cli::AddCommand* const add : cli::kCommands)
          add(app, chosen);
        CLI::App* const help =
            app.add_subcommand("help", "This text; with a command's name: what that takes");
        help->add_option("command", about, "name of a command");
        chosen.reach[help] = {};
        // --robot and the like may stand behind the subcommand as well. (Separate programs have
        // their own options, and the words of complete are for no parser.)
        for (CLI::App* command : app.get_subcommands({}))
          command->fallthrough(!command->get_allow_extras() && !command->get_prefix_command());
      },
      [&](bus::NodeOptions options, const bus::Stop& stop) -> int {
        options.for_terminal = true;
        options.others = bus::Others::noted;
        if (options.robot == cli::kEveryRobot)
          cli::expect_one_robot(*root, chosen);
        if (chosen.run) {
          const int code = chosen.run(cli::with_running_bus(*root, chosen, options), stop);
          cli::flush_output();
          if (const std::string lost = cli::out().trouble(); code == bus::kExitOk && !lost.empty())
            throw std::runtime_error(lost);
          return code;
        }
        root->clear();  // otherwise its help is that of the last command
        if (!about.empty())
          return cli::print_help(*root, about);
        std::fputs(root->help().c_str(), stdout);
        std::fputs(
            "\n./saphira test builds and runs the tests; ./saphira package makes Debian packages. "
            "README.md says how "
            "to begin.\n",
            stdout);
        return bus::kExitOk;
      });
}
