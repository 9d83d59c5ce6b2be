#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "saphira/cli/supervisor.hpp"

namespace saphira::cli {

/// A word of a deployment file, with its place, for later error messages.
struct Placed {
  std::string text;
  int line = 1;
  int column = 1;
};

/// The bus options of a deployment. Missing ones come from each program's own defaults: the
/// environment, then the built-in ones.
struct BusOptions {
  std::optional<std::string> robot;
  std::optional<std::uint32_t> domain;
  std::optional<std::string> profile;
  std::vector<std::string> peers;
  std::optional<std::string> interface;
  std::optional<std::string> security;  ///< folder of credentials, absolute, or "none"
  bool lockstep = false;
};

/// One program of a deployment.
struct Program {
  std::string name;  ///< unique in the deployment; for people
  Placed program;    ///< a program beside ours, or one on PATH, or a path
  std::vector<Placed> arguments;
  std::optional<std::string> robot;  ///< in place of the deployment's
  bool bus = true;                   ///< takes the bus options
  bool restart = true;               ///< started again when it ends
  /// On, off, or a ${setting} that is: an optional program runs where it is on.
  std::optional<Placed> when{};
};

/// The advice where saphira-speech is missing.
inline constexpr const char* kInstallSpeech =
    "install the package saphira-speech, or build where Debian's libpocketsphinx-dev, "
    "pocketsphinx-en-us, flite1-dev, libasound2-dev and libsndfile1-dev are installed";

/// The programs that run together, from config/deployments/*.yaml. The format is in
/// config/deployments/README.md.
struct Deployment {
  std::string file;
  std::string text;  ///< of the file, for messages
  BusOptions bus;
  /// Settings for the start, with defaults, which may use the built-in ${names}.
  std::map<std::string, Placed> settings;
  /// Files of ${run} that are removed before the start: their content belongs to a simulated world,
  /// which begins anew.
  std::vector<std::string> forget;
  std::vector<Program> programs;
};

/// Reads a deployment. FileError with line, column and the expected form where it is wrong.
Deployment parse_deployment(const std::string& text, const std::string& file);
Deployment load_deployment(const std::string& file);

/// The folders on this machine.
struct Places {
  std::string bin;                ///< the folder of our programs
  std::string config;             ///< the folder of our configuration: ${config}
  std::string run;                ///< sockets and files that must outlast a restart: ${run}
  std::string robot = "pioneer";  ///< ${robot} without one in the deployment
  std::string own = {};           ///< an administrator's deployments; empty: none
};
/// The places of the running program: config is ../share/saphira beside it, or the source tree's.
/// `run` is left empty; `own` is /etc/saphira where the programs are in /usr. std::runtime_error
/// when there is no config.
Places find_places();

/// The file of "demo", "demo.yaml" or a path. std::invalid_argument that lists the existing ones.
std::string find_deployment(const std::string& name, const Places& places);

/// The command lines of a deployment: ${name} replaced by the settings, ${config}, ${run} and
/// ${robot}; programs found; bus options added. FileError where a name or a program is unknown.
/// `set` are name=value words that replace settings; std::invalid_argument where one is unknown.
/// `left_out` gets a message for each optional program that is not installed; without it such a
/// program is a FileError, too.
std::vector<ChildSpec> command_lines(const Deployment& deployment, const Places& places,
                                     const std::vector<std::string>& set = {},
                                     std::vector<std::string>* left_out = nullptr);

/// The files in a command line that the unit saphira@.service does not see, since it hides homes
/// and has a /tmp of its own; a line each, with the remedy. run: a folder that does not count.
std::string hidden_from_service(const std::vector<std::string>& argv, const std::string& run);
/// The devices in a command line that this user may not open; a line each, with the remedy.
std::string closed_devices(const std::vector<std::string>& argv);

}  // namespace saphira::cli
