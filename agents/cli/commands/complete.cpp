// complete: the possible next words of a command line, for the shell (saphira.bash).
#include <algorithm>
#include <iostream>
#include <map>
#include <set>

#include "commands.hpp"
#include "direct.hpp"
#include "run_folder.hpp"
#include "saphira/base/places.hpp"
#include "saphira/bus/introspect.hpp"
#include "saphira/cli/device_words.hpp"
#include "saphira/cli/map_words.hpp"
#include "system/system.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kDeclarations{1000};  // for what programs declare: a person waits for it

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
      if (std::ranges::find(words, "--" + name) == words.end())
        words.push_back("--" + name);
}

/// A command line up to its last word, which is to be completed.
struct Begun {
  const CLI::App* command = nullptr;
  std::size_t behind = 0;  ///< words between the command and the last one, without options
  bool bus = false;        ///< it has options of all commands, perhaps those of another bus
};

Begun begun(const CLI::App& root, const std::vector<std::string>& words) {
  const auto names = commands(root);
  Begun result;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (words[i].starts_with("-")) {
      const CLI::Option* option = root.get_option_no_throw(words[i]);
      result.bus = result.bus || option != nullptr;
      if (option == nullptr && result.command != nullptr)
        option = result.command->get_option_no_throw(words[i]);
      if (option != nullptr && option->get_items_expected_min() > 0)
        ++i;  // its value
    } else if (result.command != nullptr) {
      ++result.behind;
    } else if (std::ranges::find(names, words[i]) != names.end()) {
      result.command = root.get_subcommand(words[i]);
    }
  }
  return result;
}

/// The words that are known without a bus.
std::vector<std::string> fixed_words(const CLI::App& root, const Begun& line) {
  const std::string& name = line.command->get_name();
  if (name == "help")
    return commands(root);
  if (name == "echo" || name == "write")
    return topic_names();
  if (name == "up" || name == "check" || name == "stop" || name == "renew")
    return names_in(config_folder() + "/deployments", ".yaml");
  if (name == "doctor") {
    std::vector<std::string> units;
    for (const runtime::Unit& unit : system::units())
      units.push_back(unit.name);
    return units;
  }
  if (name == "map")
    return map_verbs();
  if (name == "device") {
    std::vector<std::string> words = device_names();
    words.insert(words.begin(), {"list", "follow"});
    return words;
  }
  static const std::map<std::string, std::vector<std::string>> kWords{
      {"goal", {"go", "drive", "turn", "stop", "list", "cancel", "activities"}},
      {"why", {"not"}},
      {"beliefs", {"set", "unset"}},
      {"processes", {"interrupt", "resume", "suspend"}},
      {"knows", {"forget"}}};
  if (const auto known = kWords.find(name); known != kWords.end())
    return known->second;
  std::vector<std::string> found;
  for (const CLI::App* const part : line.command->get_subcommands({}))
    found.push_back(part->get_name());
  return found;
}

/// The goals that activities declare, or the requests that agents do.
std::vector<std::string> declared(bool goals, const bus::NodeOptions& options,
                                  const bus::Stop& stop) {
  std::set<std::string> names;
  bus::Node node(options);
  auto schemas = node.reader(bus::topics::kActivitySchemas);
  auto agents = node.reader(bus::topics::kAgents);
  const auto end = Clock::now() + kDeclarations;
  while (!stop.requested() && Clock::now() < end && !(goals && !names.empty())) {
    node.wait(std::chrono::ceil<milliseconds>(end - Clock::now()), &stop);
    if (const auto known = schemas.take_newest(); known && goals)
      for (const v1::ActivitySchema& schema : known->schemas)
        names.insert(schema.name);
    for (const auto& sample : agents.take())
      if (!goals && !sample.info.disposed)
        for (const v1::Capability& capability : sample.data.capabilities)
          names.insert(capability.functor);
  }
  return {names.begin(), names.end()};
}

/// The possible words in the place of the last of `words`.
std::vector<std::string> candidates(const CLI::App& root, const std::vector<std::string>& words,
                                    const bus::NodeOptions& options, const bus::Stop& stop) {
  const Begun line = begun(root, words);
  std::vector<std::string> found;
  // CLI11 leaves nothing of "--" alone.
  if (words.empty() || words.back().starts_with("-")) {
    if (line.command != nullptr)
      add_options(*line.command, found);
    add_options(root, found);
    return found;
  }
  if (line.command == nullptr)
    return commands(root);
  if (line.behind > 0)
    return {};
  found = fixed_words(root, line);
  const std::string& name = line.command->get_name();
  const bool named = root.get_option("--robot")->count() > 0;
  if ((name == "goal" || name == "ask") && !line.bus && (named || !running_buses().empty())) {
    try {
      for (const std::string& word : declared(name == "goal", options, stop))
        if (std::ranges::find(found, word) == found.end())
          found.push_back(word);
    } catch (const std::exception&) {
      // Without the bus there are the fixed words.
    }
  }
  return found;
}

}  // namespace

void add_complete(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("complete", "For the shell: what may come next");
  chosen.reach[command] = {};
  command->group("");
  command->set_help_flag();  // --help is a word to complete
  command->prefix_command();
  command->callback([command, &app, &chosen] {
    chosen.run = [words = command->remaining(), &app](const bus::NodeOptions& options,
                                                      const bus::Stop& stop) {
      const std::string begin = words.empty() ? "" : words.back();
      for (const std::string& word : candidates(app, words, options, stop))
        if (word.starts_with(begin))
          std::cout << word << '\n';
      return bus::kExitOk;
    };
  });
}

}  // namespace saphira::cli
