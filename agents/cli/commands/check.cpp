// check: a dry run of a deployment's programs with their options. Running programs are not
// affected.
#include "check.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "behaviors/shell/convert.hpp"
#include "commands.hpp"
#include "environment.hpp"
#include "intentions/shell/convert.hpp"
#include "run_folder.hpp"
#include "saphira/behaviors/folder.hpp"
#include "saphira/cli/printer.hpp"
#include "saphira/intentions/activity_folders.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/intentions/navigation.hpp"

namespace saphira::cli {

namespace {

constexpr const char* kIntentions = "saphira-intentions";

std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word)
    text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// A dry run of one program. Only saphira's programs are run: others may not know the option
/// --dry-run.
Said ask(const ChildSpec& child) {
  std::string command = "env";
  for (const auto& [name, value] : child.environment)
    command += " " + quoted(name + "=" + value);
  for (const std::string& word : child.argv)
    command += " " + quoted(word);
  return said_by(command + " --dry-run 2>&1 </dev/null");
}

/// The command lines of its programs, for this run folder. The memory of a running deployment is
/// not touched.
std::vector<ChildSpec> dry_lines(const Deployment& deployment, Places places,
                                 const RunFolder& folder, const std::vector<std::string>& set,
                                 const bus::NodeOptions& options,
                                 std::vector<std::string>& left_out) {
  places.run = folder.path();
  places.robot = options.robot;
  return command_lines_on(options, deployment, places, set, &left_out);
}

std::string program_of(const ChildSpec& child) {
  return std::filesystem::path(child.argv.at(0)).filename();
}
bool can_be_asked(const ChildSpec& child) {
  return program_of(child).starts_with("saphira-");
}

/// The values of an option of a program of the deployment.
std::vector<std::string> values(const std::vector<ChildSpec>& children, const std::string& program,
                                const std::string& option) {
  std::vector<std::string> all;
  for (const ChildSpec& child : children)
    for (std::size_t i = 1; program_of(child) == program && i + 1 < child.argv.size(); ++i)
      if (child.argv[i] == option && !child.argv[i + 1].empty())
        all.push_back(child.argv[i + 1]);
  return all;
}

/// Activities that name a behavior which the behaviors of the deployment do not have. No program
/// can tell by itself: one has the activities, and another the behaviors.
std::string unknown_behaviors(const std::vector<ChildSpec>& children) {
  const std::string behaviors = "saphira-behaviors";
  const auto folders = values(children, kIntentions, "--activities");
  if (folders.empty() || !values(children, behaviors, "--plugin").empty() ||
      std::none_of(children.begin(), children.end(),
                   [&](const ChildSpec& child) { return program_of(child) == behaviors; }))
    return {};
  behaviors::Sources sources;
  sources.add(behaviors::Folder(behaviors::behaviors_folder()));
  for (const std::string& folder : values(children, behaviors, "--behaviors"))
    sources.add(behaviors::Folder(folder));
  behaviors::Registry registry;
  sources.reload(registry);
  std::vector<std::string> paths{intentions::activities_folder()};
  paths.insert(paths.end(), folders.begin(), folders.end());
  intentions::ActivityFolders activities(paths, intentions::all_functions(),
                                         intentions::built_in());
  activities.know_behaviors(intentions::from_bus(behaviors::to_bus(registry, "")));
  std::string text;
  for (const std::string& error : activities.reload().errors)
    text += error + "\n";
  return text;
}

int check(const std::string& name, const std::vector<std::string>& set,
          const bus::NodeOptions& options) {
  const Places places = find_places();
  const Deployment deployment = load_deployment(find_deployment(name, places));
  const RunFolder folder;
  std::size_t wrong = 0;
  std::size_t misused = 0;
  std::vector<std::string> left_out;
  const auto children = dry_lines(deployment, places, folder, set, options, left_out);
  for (const ChildSpec& child : children) {
    if (!can_be_asked(child)) {
      print("%-15s not asked: %s is no program of saphira\n", child.name.c_str(),
            program_of(child).c_str());
      continue;
    }
    Said said = ask(child);
    if (said.well && program_of(child) == kIntentions)
      if (const std::string wrong_names = unknown_behaviors(children); !wrong_names.empty())
        said = {false, false, said.text + wrong_names};
    print("%-15s %s\n%s", child.name.c_str(),
          !said.well          ? "WRONG"
          : said.text.empty() ? "ok"
                              : "would start, but says",
          said.text.c_str());
    const bool of_service = !places.own.empty() && deployment.file.starts_with(places.own);
    const std::string unseen =
        closed_devices(child.argv) +
        (of_service ? hidden_from_service(child.argv, folder.path()) : std::string());
    print("%s", unseen.c_str());
    wrong += said.well && unseen.empty() ? 0 : 1;
    misused += said.misused ? 1 : 0;
  }
  for (const std::string& text : left_out)
    print("%s\n", text.c_str());
  if (wrong == 0)
    print("%s would start%s\n", deployment.file.c_str(),
          left_out.empty() ? "" : ", without the programs left out above");
  else if (misused == 0)
    print("%s would start, but %zu of its programs would not run as %s should\n",
          deployment.file.c_str(), wrong, wrong == 1 ? "it" : "they");
  else
    print("%s would not start: %zu of its programs %s\n", deployment.file.c_str(), misused,
          misused == 1 ? "refuses its options" : "refuse their options");
  return wrong == 0 ? bus::kExitOk : bus::kExitUsage;
}

}  // namespace

Said said_by(const std::string& command) {
  FILE* const output = popen(command.c_str(), "r");
  if (output == nullptr)
    return {false, false, "it cannot be started"};
  Said said;
  std::array<char, 4096> part;
  while (fgets(part.data(), part.size(), output) != nullptr)
    said.text += part.data();
  const int status = pclose(output);
  said.well = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  said.misused = WIFEXITED(status) && WEXITSTATUS(status) == bus::kExitUsage;
  return said;
}

std::string refusal(const Deployment& deployment, const Places& places,
                    const std::vector<std::string>& set, const bus::NodeOptions& options) {
  const RunFolder folder;
  std::vector<std::string> left_out;
  for (const ChildSpec& child : dry_lines(deployment, places, folder, set, options, left_out)) {
    // Another program may not know a dry run: it would be refused, or go on.
    const bool ours = std::filesystem::path(child.argv.at(0)).parent_path() == places.bin &&
                      (!child.robot.empty() || program_of(child) == "saphira-sim");
    const Said said = ours && can_be_asked(child) ? ask(child) : Said{};
    if (said.misused)
      return child.name + " refuses the options of " + deployment.file + "\n" + said.text;
  }
  return {};
}

void add_check(CLI::App& app, Chosen& chosen) {
  struct Options {
    std::string deployment;
    std::vector<std::string> set;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "check",
      "Check a deployment without starting it: its file, and all files that its programs get");
  command->add_option("deployment", options->deployment, "a file, or a shipped one such as demo")
      ->required();
  command->add_option("--set", options->set, "name=value: a setting of the deployment")
      ->take_all()
      ->type_size(1);
  chosen.apart.insert(command);
  command->footer("Nothing is started, and what runs is not touched. Exit code 0: it would start.");
  chosen.when(command, [options](const bus::NodeOptions& node, const bus::Stop&) {
    return check(options->deployment, options->set, node);
  });
}

}  // namespace saphira::cli
