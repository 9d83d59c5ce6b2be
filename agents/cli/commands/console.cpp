#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "commands.hpp"
#include "environment.hpp"
#include "saphira/base/places.hpp"

namespace saphira::cli {

namespace {

/// The program in our place, with the bus that was asked for here.
int console(const bus::NodeOptions& options, const std::vector<std::string>& arguments) {
  for (const auto& [name, value] : as_environment(options))
    if (!value.empty())
      setenv(name.c_str(), value.c_str(), 1);
  std::vector<std::string> words{program_folder() + "/saphira-console"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words)
    argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(argv[0], argv.data());
  throw std::system_error(errno, std::generic_category(), words[0]);
}

}  // namespace

void add_console(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand(
      "console", "See the robot think and drive it, in a browser; or --screenshot FILE");
  command->allow_extras();
  command->footer("What it takes: saphira-console --help. Deployments such as demo start one.");
  command->callback([command, &chosen] {
    chosen.run = [rest = command->remaining()](const bus::NodeOptions& options, const bus::Stop&) {
      return console(options, rest);
    };
  });
}

}  // namespace saphira::cli
