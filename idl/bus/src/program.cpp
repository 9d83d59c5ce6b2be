#include "saphira/bus/program.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "internal.hpp"
#include "log.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"

namespace saphira::bus {

namespace {

/// Where the credentials of this machine or user are, if it has any. A user who has an authority
/// has them also before they are made: nothing starts open by accident then.
std::string usual_security() {
  const auto is_folder = [](const std::string& path) {
    std::error_code error;
    return std::filesystem::is_directory(path, error);
  };
  if (const std::string machine = "/etc/saphira/credentials"; is_folder(machine))
    return machine;
  const std::string user = user_folder();
  if (!user.empty() && (is_folder(user + "/credentials") || is_folder(user + "/authority")))
    return user + "/credentials";
  return {};
}

}  // namespace

void add_node_options(CLI::App& app, NodeOptions& options) {
  app.add_option("--name", options.name, "Name of this program on the bus")->capture_default_str();
  app.add_option("--robot", options.robot, "The robot to belong to")
      ->envname("SAPHIRA_ROBOT")
      ->capture_default_str();
  app.add_option("--domain", options.domain, "DDS domain")
      ->envname("SAPHIRA_DOMAIN")
      ->check(CLI::Range(0, 231))
      ->capture_default_str();
  static const std::map<std::string, Profile> profiles{
      {"host", Profile::host}, {"lan", Profile::lan}, {"wan", Profile::wan}};
  app.add_option_function<std::string>(
         "--profile",
         [&options](const std::string& profile) { options.profile = profiles.at(profile); },
         "Network: host (this machine alone), lan (multicast), wan (--peer)")
      ->envname("SAPHIRA_PROFILE")
      ->check(CLI::IsMember({"host", "lan", "wan"}))
      ->default_str("host");
  app.add_option("--peer", options.peers,
                 "wan: addresses of other machines; one that all of them name is enough")
      ->envname("SAPHIRA_PEERS")
      ->delimiter(',');
  app.add_option("--interface", options.interface, "lan, wan: address of the one interface to use")
      ->envname("SAPHIRA_INTERFACE")
      ->check(CLI::ValidIPV4);
  options.security = usual_security();
  app.add_option("--security", options.security,
                 "Folder of credentials (saphira security add); none: a bus that is open to all")
      ->envname("SAPHIRA_SECURITY")
      ->default_str(options.security.empty() ? kOpenBus : options.security);
  app.add_flag("--dry-run", options.dry_run,
               "Read what is given here, say what is wrong with it, and end");
  app.add_flag("--lockstep", options.lockstep,
               "Lose no sample of a cycle and wait for every input (simulator in single step)");
  app.add_option_function<std::string>(
         "--log-level", [](const std::string& level) { internal::set_log_level(level); },
         "What is written to stderr: debug, info, warning or error")
      ->check(CLI::IsMember({"debug", "info", "warning", "error"}))
      ->default_str("info");
}

namespace {

/// Names the word that no option or command takes, with the nearest one that there is.
int not_understood(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty())
    command = command->get_subcommands().front();
  std::vector<std::string> known;
  for (const CLI::App* const each : command->get_subcommands({}))
    known.push_back(each->get_name());
  for (const CLI::Option* const each : command->get_options())
    for (const std::string& name : each->get_lnames())
      known.push_back("--" + name);
  const std::vector<std::string> words = app.remaining(true);
  const std::string word = words.empty() ? "" : words.front();
  const std::string meant = guess(word, known);
  std::fprintf(
      stderr, "%s: \"%.200s\" is not understood%s\n", app.get_name().c_str(), word.c_str(),
      meant.empty() ? "; --help lists the options" : (": did you mean " + meant + "?").c_str());
  return kExitUsage;
}

}  // namespace

const char* version() {
  return "saphira " SAPHIRA_VERSION ", contract " SAPHIRA_CONTRACT;
}

int run_program(int argc, char** argv, const std::string& name, const std::string& description,
                const std::function<void(CLI::App&)>& add_options,
                const std::function<int(const NodeOptions&, const Stop&)>& body) {
  NodeOptions options;
  options.name = name;
  options.program = name;
  CLI::App app{description, "saphira-" + name};
  add_node_options(app, options);
  app.set_version_flag("--version", version());
  if (add_options)
    add_options(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ExtrasError&) {
    return not_understood(app);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitOk : kExitUsage;
  }
  internal::has_worked() = false;
  std::string what;
  std::string usage;  // what of that is told to the person who gave us something wrong
  try {
    Stop stop;
    stop_on_signals(stop);
    if (options.dry_run) {
      internal::check_credentials(options);
      stop.request();
    }
    return body(options, stop);
  } catch (const FileError& error) {
    usage = what = error.what();
  } catch (const std::invalid_argument& error) {
    what = error.what();
    usage = "saphira-" + options.name + ": " + what;
  } catch (const std::exception& error) {
    what = error.what();
  }
  // What a person gave is read before the work begins. Later the mistake is ours, and whoever
  // started us may do so again.
  if (!usage.empty() && !internal::has_worked()) {
    std::fprintf(stderr, "%s\n", usage.c_str());
    return kExitUsage;
  }
  internal::write_log(v1::LOG_ERROR, options.name + ": " + what);
  return kExitBroken;
}

}  // namespace saphira::bus
