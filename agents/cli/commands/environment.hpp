#pragma once

#include <deque>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/bus/node.hpp"
#include "saphira/cli/deployment.hpp"
#include "saphira/cli/running_bus.hpp"

namespace saphira::cli {

/// Our bus options, for programs that we start.
std::map<std::string, std::string> as_environment(const bus::NodeOptions& options);

/// The bus of these options, for other commands (FoundBus).
RunningBus bus_of(const std::string& what, const bus::NodeOptions& options);

/// The options of a program on this bus.
bus::NodeOptions on_bus(const RunningBus& bus, bus::NodeOptions options);

/// A private bus: a robot name of its own, and unless a domain was given, a random one. name: of
/// the command.
bus::NodeOptions own_bus(bus::NodeOptions options, const std::string& name);

/// The deployment of that name on such a bus of one machine, without the programs that are for
/// people or optional; with_people: with all.
Deployment own_deployment(const std::string& name, const Places& places,
                          const bus::NodeOptions& options, bool with_people);
/// Puts the programs into one, saphira-all, which takes the options of all, and those of the bus
/// once; without those of these names.
void put_in_one(Deployment& deployment, const std::set<std::string>& without = {});
/// As command_lines, for our bus.
std::vector<ChildSpec> command_lines_on(const bus::NodeOptions& options,
                                        const Deployment& deployment, const Places& places,
                                        const std::vector<std::string>& set,
                                        std::vector<std::string>* left_out = nullptr);

/// The last lines of programs, as they are shown after a failure.
class Kept {
 public:
  explicit Kept(std::size_t most) : most_(most) {}
  /// Returns the whole line: "behaviors | it says this".
  const std::string& add(std::string_view from, std::string_view line);
  const std::deque<std::string>& lines() const { return lines_; }

 private:
  std::size_t most_;
  std::deque<std::string> lines_;
};

/// Runs the program words[0] in our place. std::system_error where it cannot.
[[noreturn]] void execute(std::vector<std::string> words);

}  // namespace saphira::cli
