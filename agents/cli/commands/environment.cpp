#include "environment.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <random>
#include <system_error>

#include "saphira/base/text.hpp"
#include "saphira/bus/program.hpp"
#include "watch.hpp"

namespace saphira::cli {

std::map<std::string, std::string> as_environment(const bus::NodeOptions& options) {
  return {{"SAPHIRA_ROBOT", options.robot},
          {"SAPHIRA_DOMAIN", std::to_string(options.domain)},
          {"SAPHIRA_PROFILE", name_of(options.profile)},
          {"SAPHIRA_PEERS", joined(options.peers, ",")},
          {"SAPHIRA_INTERFACE", options.interface},
          {"SAPHIRA_SECURITY", options.security.empty() ? bus::kOpenBus : options.security}};
}

RunningBus bus_of(const std::string& what, const bus::NodeOptions& options) {
  return {what,           options.robot,
          options.domain, name_of(options.profile),
          options.peers,  options.interface,
          false,          options.security.empty() ? bus::kOpenBus : options.security};
}

bus::NodeOptions on_bus(const RunningBus& bus, bus::NodeOptions options) {
  options.robot = bus.robot;
  options.domain = bus.domain;
  options.profile = bus::profile_of(bus.profile);
  options.peers = bus.peers;
  options.interface = bus.interface;
  options.security = bus.security;
  return options;
}

bus::NodeOptions own_bus(bus::NodeOptions options, const std::string& name) {
  const char* const given = std::getenv("SAPHIRA_DOMAIN");
  // Above 100 the ports of a domain overlap the kernel's ephemeral ports.
  if (options.domain == 0 && (given == nullptr || *given == '\0'))
    options.domain = 60 + std::random_device{}() % 40;
  options.robot = name + "-" + std::to_string(getpid());
  options.profile = bus::Profile::host;
  options.peers.clear();
  options.interface.clear();
  options.name = name;
  options.lockstep = false;  // this program only watches
  return options;
}

Deployment own_deployment(const std::string& name, const Places& places,
                          const bus::NodeOptions& options, bool with_people) {
  Deployment deployment = load_deployment(find_deployment(name, places));
  deployment.bus.robot = options.robot;
  deployment.bus.domain = options.domain;
  deployment.bus.profile = "host";
  if (!with_people)
    std::erase_if(deployment.programs,
                  [](const Program& program) { return program.name == "console" || program.when; });
  return deployment;
}

void put_in_one(Deployment& deployment, const std::set<std::string>& without) {
  Program all{"all", {"saphira-all"}, {}, {}, true, true};
  for (const Program& program : deployment.programs)
    if (!without.contains(program.name))
      all.arguments.insert(all.arguments.end(), program.arguments.begin(), program.arguments.end());
  deployment.programs = {all};
}

std::vector<ChildSpec> command_lines_on(const bus::NodeOptions& options,
                                        const Deployment& deployment, const Places& places,
                                        const std::vector<std::string>& set,
                                        std::vector<std::string>* left_out) {
  std::vector<ChildSpec> children = command_lines(deployment, places, set, left_out);
  for (ChildSpec& child : children)
    child.environment.merge(as_environment(options));
  return children;
}

const std::string& Kept::add(std::string_view from, std::string_view line) {
  lines_.push_back((from.empty() ? "saphira" : std::string(from)) + " | " + std::string(line));
  if (lines_.size() > most_)
    lines_.pop_front();
  return lines_.back();
}

void execute(std::vector<std::string> words) {
  execv(words[0].c_str(), pointers(words).data());
  throw std::system_error(errno, std::generic_category(), words[0]);
}

}  // namespace saphira::cli
