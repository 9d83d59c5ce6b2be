#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "commands.hpp"
#include "run_folder.hpp"
#include "saphira/cli/deployment.hpp"
#include "saphira/cli/printer.hpp"
#include "saphira/cli/supervisor.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

/// The bus options that were given to us, for children whose deployment does not state them.
std::map<std::string, std::string> as_environment(const bus::NodeOptions& options) {
  std::string peers;
  for (const std::string& peer : options.peers)
    peers += (peers.empty() ? "" : ",") + peer;
  return {{"SAPHIRA_ROBOT", options.robot},
          {"SAPHIRA_DOMAIN", std::to_string(options.domain)},
          {"SAPHIRA_PROFILE", name_of(options.profile)},
          {"SAPHIRA_PEERS", peers},
          {"SAPHIRA_INTERFACE", options.interface}};
}

/// Prints with the child's name before each line, in a color of its own on a terminal.
Supervisor::Print prefixed(const std::vector<ChildSpec>& children) {
  std::size_t width = std::string("saphira").size();
  std::vector<std::string> names;
  for (const ChildSpec& child : children) {
    width = std::max(width, child.name.size());
    names.push_back(child.name);
  }
  const bool colors = isatty(STDOUT_FILENO) != 0;
  return [width, names, colors](std::string_view from, std::string_view line) {
    const auto index =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), from) - names.begin());
    const std::string_view name = from.empty() ? "saphira" : from;
    std::string text;
    if (colors)
      text += from.empty() ? "\x1b[1m" : "\x1b[3" + std::to_string(2 + index % 5) + "m";
    text += name;
    text.append(width - std::min(width, name.size()), ' ');
    text += " | ";
    if (colors)
      text += "\x1b[0m";
    text += line;
    text += '\n';
    out().print(text);
  };
}

int up(const std::string& name, const std::vector<std::string>& set,
       const bus::NodeOptions& options, const bus::Stop& stop) {
  Places places = find_places();
  const Deployment deployment = load_deployment(find_deployment(name, places));
  // Two robots by one file are two deployments.
  const std::string robot = deployment.bus.robot.value_or(options.robot);
  const RunFolder folder(std::filesystem::path(deployment.file).stem().string() + "-" + robot +
                         "-" + std::to_string(deployment.bus.domain.value_or(options.domain)));
  places.run = folder.path();
  places.robot = options.robot;
  std::vector<ChildSpec> children = command_lines(deployment, places, set);
  ProgramLocks locks;
  for (ChildSpec& child : children) {
    child.environment.merge(as_environment(options));
    if (!child.robot.empty())
      locks.hold(child.name, child.robot, deployment.bus.domain.value_or(options.domain),
                 deployment.file + " (process " + std::to_string(getpid()) + ")");
  }

  const Supervisor::Print print = prefixed(children);
  Supervisor supervisor(std::move(children), print);
  supervisor.start();
  print({}, std::to_string(supervisor.children().size()) + " programs of " + deployment.file +
                " started; Ctrl-C stops them");
  while (!stop.requested() && !supervisor.finished() && !supervisor.misused())
    supervisor.step(std::chrono::seconds(10), {stop.fd()});
  const auto misused = supervisor.misused();
  supervisor.stop();
  if (misused) {
    print({}, *misused + " does not take what " + deployment.file + " gives it: see above");
    return bus::kExitUsage;
  }
  print({}, "all stopped");
  return bus::kExitOk;
}

}  // namespace

void add_up(CLI::App& app, Chosen& chosen) {
  struct Options {
    std::string deployment;
    std::vector<std::string> set;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("up", "Start and supervise what a deployment file lists");
  command->add_option("deployment", options->deployment, "a file, or a shipped one such as demo")
      ->required();
  command->add_option("--set", options->set, "name=value: a setting of the deployment")
      ->take_all()
      ->type_size(1);
  command->callback([options, &chosen] {
    chosen.run = [options](const bus::NodeOptions& node, const bus::Stop& stop) {
      try {
        return up(options->deployment, options->set, node, stop);
      } catch (const std::invalid_argument& error) {
        std::cerr << "saphira: " << error.what() << '\n';
        return static_cast<int>(bus::kExitUsage);
      }
    };
  });
}

}  // namespace saphira::cli
