#pragma once

#include <functional>
#include <set>
#include <string>

#include "saphira/bus/introspect.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/cli/words.hpp"
#include "saphira/watch/processes.hpp"

namespace saphira::cli {

using watch::absence;
using watch::Clock;
using watch::keep_newest;
using watch::listening_time;
using watch::name_of;
using watch::Newest;
using watch::poll_for;
using watch::Processes;
using watch::seconds_since;
using watch::wait_for;
using watch::who_is_there;

/// Warns once when two deployments have this robot, in any command.
class DeploymentWatch {
 public:
  DeploymentWatch(bus::Node& node, Processes& processes) : node_(node), processes_(processes) {}

  /// Polls the processes as well.
  void poll();
  /// For the end of a command: waits until a second deployment is confirmed or excluded.
  void settle(const bus::Stop& stop);

 private:
  bus::Node& node_;
  Processes& processes_;
  SecondDeployment second_;
};

/// A program of this name and its user, for people: "keyboard of ann at laptop (pts/3)"; with
/// `since`, also the time of this call: "(pts/3, since 14:02)".
std::string person(const std::string& program, bool since = false);

/// The end of a list without items, with the reason `why`: a failure where nobody is on the bus.
int nothing_there(const std::string& what, const Processes& processes, const std::string& why);

/// In place of a robot's name.
inline constexpr const char* kEveryRobot = "*";
/// "robot flakey", or "every robot".
std::string called(const std::string& robot);
/// The robots of the domain with a program that `tells`; they are listened for.
std::set<std::string> robots_heard(const bus::NodeOptions& options, const bus::Stop& stop,
                                   const std::function<bool(const bus::EndpointEntry&)>& tells);

constexpr double kEmptyBus = 5.0;  ///< [s] until a question is given up where no program is heard

/// The program that answers requests on agents/solve.
inline constexpr const char* kFacilitator = "facilitator";

/// RequestClient::ask, on a topic that only this program answers. Where it is not on the bus, that
/// ends it at once, and is the text of the answer.
v1::Answer ask_program(const std::string& program, bus::Node& node, bus::RequestClient& client,
                       const v1::Request& request, double patience, const bus::Stop& stop,
                       Processes& processes, bus::RequestClient::Hear hear = {});

}  // namespace saphira::cli
