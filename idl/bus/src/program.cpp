#include "saphira/bus/program.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "internal.hpp"
#include "log.hpp"
#include "saphira/base/output.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/robot_name.hpp"
#include "saphira/base/text.hpp"

namespace saphira::bus {

namespace {

/// The folder of credentials of this user, or else of this machine; empty: there is none. A user
/// with an authority needs a folder even before it exists, so that nothing starts open by accident.
std::string usual_security() {
  const auto is_folder = [](const std::string& path) {
    std::error_code error;
    return std::filesystem::is_directory(path, error);
  };
  const std::string folder = user_folder();
  const std::string user = folder + "/credentials";
  if (!folder.empty() && is_folder(user))
    return user;
  if (const std::string machine = "/etc/saphira/credentials"; is_folder(machine))
    return machine;
  return !folder.empty() && is_folder(folder + "/authority") ? user : std::string();
}

void add_node_options(CommandLine& app, NodeOptions& options) {
  app.add_option("--name", options.name, "Name of this program on the bus");
  app.add_option("--robot", options.robot, "The robot to belong to")
      .environment("SAPHIRA_ROBOT")
      .check(trouble_of_robot);
  app.add_option("--domain", options.domain, "DDS domain")
      .environment("SAPHIRA_DOMAIN")
      .in_range(0, 231);
  app.add_action(
         "--profile",
         [&options](const std::string& profile) { options.profile = profile_of(profile); },
         "Network: host (this machine alone), lan (multicast), wan (--peer)")
      .environment("SAPHIRA_PROFILE")
      .one_of({"host", "lan", "wan"})
      .shows("host");
  app.add_option("--peer", options.peers,
                 "wan: addresses of other machines; one that all of them name is enough")
      .environment("SAPHIRA_PEERS")
      .separated_by(',');
  app.add_option("--interface", options.interface, "lan, wan: address of the one interface to use")
      .environment("SAPHIRA_INTERFACE")
      .ipv4();
  options.security = usual_security();
  app.add_option("--security", options.security,
                 "Folder of credentials (saphira security add); none: a bus that is open to all")
      .environment("SAPHIRA_SECURITY")
      .shows(options.security.empty() ? kOpenBus : options.security);
  app.add_flag("--dry-run", options.dry_run, "Check the options and files, report errors, and end");
  app.add_flag("--lockstep", options.lockstep,
               "Lose no sample of a cycle and wait for every input (simulator in single step)");
  app.add_action(
         "--log-level", [](const std::string& level) { internal::set_log_level(level); },
         "Least severe messages on stderr: debug, info, warning or error")
      .one_of({"debug", "info", "warning", "error"})
      .shows("info");
}

}  // namespace

Profile profile_of(const std::string& word) {
  static const std::map<std::string, Profile> profiles{
      {"host", Profile::host}, {"lan", Profile::lan}, {"wan", Profile::wan}};
  return profiles.at(word);
}

NodeOptions options_of_environment() {
  NodeOptions options;
  CommandLine line("", "environment");
  add_node_options(line, options);
  const char* const program = "environment";
  if (line.parse(1, &program))
    throw std::invalid_argument("an environment variable of the bus (SAPHIRA_...) cannot be");
  return options;
}

const char* version() {
  return "saphira " SAPHIRA_VERSION ", contract " SAPHIRA_CONTRACT;
}

int run_program(int argc, char** argv, const std::string& name, const std::string& description,
                const std::function<void(CommandLine&)>& add_options,
                const std::function<int(const NodeOptions&, const Stop&)>& body) {
  NodeOptions options;
  options.name = name;
  options.program = name;
  CommandLine app{description, "saphira-" + name};
  add_node_options(app, options);
  app.add_version(version());
  if (add_options)
    add_options(app);
  if (const std::optional<int> code = app.parse(argc, argv))
    return *code;
  internal::has_worked() = false;
  internal::has_erred() = false;
  std::string what;
  std::string usage;  // the first such error, for the person who gave the input
  try {
    Stop stop;
    stop_on_signals(stop);
    if (options.dry_run) {
      internal::check_credentials(options);
      stop.request();
    }
    const int code = body(options, stop);
    if (const std::string lost = flush_standard_output(); code == kExitOk && !lost.empty())
      throw std::runtime_error(lost);
    // A mistake that a running program only reports also fails a dry run.
    return options.dry_run && code == kExitOk && internal::has_erred() ? kExitFailed : code;
  } catch (const FileError& error) {
    usage = what = error.what();
  } catch (const std::invalid_argument& error) {
    what = error.what();
    usage = app.program() + ": " + what;
  } catch (const UnusableFile& error) {
    what = error.what();
    usage = app.program() + ": " + what;
  } catch (const std::exception& error) {
    what = error.what();
  }
  // Input from people is read before the work begins: only then is a mistake theirs. A later one is
  // ours, and a supervisor may start this program again.
  if (!usage.empty() && !internal::has_worked()) {
    std::fprintf(stderr, "%s\n", usage.c_str());
    return kExitUsage;
  }
  if (app.program() == "saphira-" + name)
    internal::write_log(v1::LOG_ERROR, options.name, what);
  else  // a command that people give, no service with a log
    std::fprintf(stderr, "%s: %s\n", app.program().c_str(), what.c_str());
  return kExitBroken;
}

}  // namespace saphira::bus
