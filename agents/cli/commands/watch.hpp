#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "saphira/bus/node.hpp"
#include "saphira/cli/second_deployment.hpp"
#include "saphira/cli/words.hpp"

namespace saphira::cli {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point when) {
  return std::chrono::duration<double>(Clock::now() - when).count();
}

/// Keeps what every process said of itself last.
class Processes {
 public:
  explicit Processes(bus::Node& node) : reader_(node.reader(bus::topics::kStatus)) {}

  void poll();
  std::vector<SeenProcess> all() const;
  /// The part of the robot's situation that their status gives, without cyclic topics.
  situation::Situation situation() const;
  /// Of all processes that were seen, also those that ended.
  std::uint64_t late_cycles() const;

 private:
  struct Entry {
    v1::ServiceStatus status;
    Clock::time_point came;
    bool gone = false;  ///< in good order
  };
  bus::Reader<v1::ServiceStatus> reader_;
  std::map<std::uint64_t, Entry> entries_;
  Clock::time_point began_ = Clock::now();
};

/// Complains once when two deployments have this robot, whatever else a command shows.
class DeploymentWatch {
 public:
  DeploymentWatch(bus::Node& node, Processes& processes) : node_(node), processes_(processes) {}

  /// Polls the processes as well.
  void poll();
  /// For the end of a command: waits until it is certain whether there is a second deployment.
  void settle(const bus::Stop& stop);

 private:
  bus::Node& node_;
  Processes& processes_;
  SecondDeployment second_;
};

/// The profile's word: host, lan, wan.
const char* name_of(bus::Profile profile);

/// A program of this name and the person who runs it, for people: "keyboard of ann at laptop
/// (pts/3)"; with `since`, also the time of day when this was asked: "(pts/3, since 14:02)".
std::string person(const std::string& program, bool since = false);

/// The programs that are missing or in trouble, in words, for when nobody answers.
std::string who_is_there(const bus::NodeOptions& options, const Processes& processes);

}  // namespace saphira::cli
