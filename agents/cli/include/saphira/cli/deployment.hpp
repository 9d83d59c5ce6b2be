#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "saphira/cli/supervisor.hpp"

namespace saphira::cli {

/// A word of a deployment file, with where it stands, for messages about what it turns out to mean.
struct Placed {
  std::string text;
  int line = 1;
  int column = 1;
};

/// The bus options that a deployment states. What it does not state comes from each program's own
/// defaults: the environment, then the built-in ones.
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
  bool bus = true;                   ///< whether it takes the bus options
  bool restart = true;               ///< whether it is started again when it ends
};

/// The programs that run together, as config/deployments/*.yaml states them. The format is in
/// config/deployments/README.md.
struct Deployment {
  std::string file;
  std::string text;  ///< of the file, for messages
  BusOptions bus;
  /// May be set when it is started; with defaults, in which the built-in ${names} count.
  std::map<std::string, Placed> settings;
  /// Files of ${run} that are removed before it starts: what they remember is of a simulated world,
  /// which begins anew.
  std::vector<std::string> forget;
  std::vector<Program> programs;
};

/// Reads a deployment. FileError with line, column and what was expected where it is wrong.
Deployment parse_deployment(const std::string& text, const std::string& file);
Deployment load_deployment(const std::string& file);

/// Where things are on this machine.
struct Places {
  std::string bin;                ///< the folder of our programs
  std::string config;             ///< the folder of our configuration: ${config}
  std::string run;                ///< for sockets and what must outlast a restart: ${run}
  std::string robot = "pioneer";  ///< ${robot} where the deployment states none
  std::string own = {};           ///< an administrator's deployments; empty: there are none
};
/// The places of the running program: config is ../share/saphira beside it, or the source tree's.
/// `run` is left empty; `own` is /etc/saphira where the programs are in /usr. std::runtime_error
/// when there is no config.
Places find_places();

/// The file that a person means by "demo", "demo.yaml" or a path. std::invalid_argument that
/// lists what there is.
std::string find_deployment(const std::string& name, const Places& places);

/// The command lines of a deployment: ${name} replaced by the settings, ${config}, ${run} and
/// ${robot}; programs found; bus options added. FileError where a name or a program is unknown.
/// `set` are name=value words that replace settings; std::invalid_argument where one is unknown.
std::vector<ChildSpec> command_lines(const Deployment& deployment, const Places& places,
                                     const std::vector<std::string>& set = {});

}  // namespace saphira::cli
