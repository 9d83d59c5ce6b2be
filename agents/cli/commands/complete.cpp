// complete: the possible next words of a command line, for the shell (saphira.bash).
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>

#include "commands.hpp"
#include "saphira/base/places.hpp"
#include "saphira/bus/introspect.hpp"

namespace saphira::cli {

namespace {

std::vector<std::string> shipped(const std::string& folder, const std::string& extension) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry :
       std::filesystem::directory_iterator(config_folder() + "/" + folder, none))
    if (entry.path().extension() == extension)
      names.push_back(entry.path().stem());
  return names;
}

std::vector<std::string> topics() {
  std::vector<std::string> names;
  for (const bus::TopicEntry& topic : bus::known_topics())
    names.push_back(topic.name);
  return names;
}

std::vector<std::string> commands(const CLI::App& root) {
  std::vector<std::string> names;
  for (const CLI::App* const command : root.get_subcommands({}))
    if (!command->get_group().empty())
      names.push_back(command->get_name());
  return names;
}

void add_options(const CLI::App& command, std::vector<std::string>& words) {
  for (const CLI::Option* const option : command.get_options())
    for (const std::string& name : option->get_lnames())
      words.push_back("--" + name);
}

/// The possible words in the place of the last of `words`.
std::vector<std::string> candidates(const CLI::App& root, const std::vector<std::string>& words) {
  const auto names = commands(root);
  const CLI::App* command = nullptr;
  std::size_t behind = 0;  // words between the command and the last one
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (command != nullptr)
      ++behind;
    else if (std::find(names.begin(), names.end(), words[i]) != names.end())
      command = root.get_subcommand(words[i]);
  }
  std::vector<std::string> found;
  if (!words.empty() && words.back().starts_with("-")) {
    if (command != nullptr)
      add_options(*command, found);
    add_options(root, found);
    return found;
  }
  if (command == nullptr)
    return names;
  if (behind > 0)
    return {};
  const std::string& name = command->get_name();
  if (name == "help")
    return names;
  if (name == "echo" || name == "write")
    return topics();
  if (name == "up" || name == "stop")
    return shipped("deployments", ".yaml");
  static const std::map<std::string, std::vector<std::string>> kWords{
      {"goal", {"go", "drive", "turn", "stop", "list", "cancel", "activities"}},
      {"why", {"not"}},
      {"beliefs", {"set", "unset"}},
      {"processes", {"interrupt", "resume", "suspend"}},
      {"map",
       {"follow", "list", "save", "show", "build", "load", "delete", "put", "remove", "place",
        "find", "on", "off", "features", "snap", "route"}}};
  if (const auto known = kWords.find(name); known != kWords.end())
    return known->second;
  for (const CLI::App* const part : command->get_subcommands({}))
    found.push_back(part->get_name());
  return found;
}

}  // namespace

void add_complete(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("complete", "For the shell: what may come next");
  command->group("");
  command->prefix_command();
  command->callback([command, &app, &chosen] {
    chosen.run = [words = command->remaining(), &app](const bus::NodeOptions&, const bus::Stop&) {
      for (const std::string& word : candidates(app, words))
        std::cout << word << '\n';
      return bus::kExitOk;
    };
  });
}

}  // namespace saphira::cli
