#pragma once

#include <map>
#include <utility>
#include <vector>

#include "agent_interface/shell/robot_agent.hpp"
#include "saphira/agent_interface/facilitator.hpp"
#include "saphira/bus/audit.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::agent_interface {

/// The facilitator on the bus. For the node's own thread.
class FacilitatorShell {
 public:
  /// memory: a file by which nothing is done twice over a restart [empty: none].
  FacilitatorShell(bus::Node& node, double now, std::string memory = {});

  /// Takes the inputs and sends the outputs. now: [s] of a clock that never goes back.
  void step(double now);
  /// Until stop is requested, or another facilitator of this robot has served (bus::Namesakes).
  void run(const bus::Stop& stop);
  /// [s] The clock of run().
  static double seconds();

 private:
  using RequestId = std::pair<std::uint64_t, std::uint64_t>;  ///< asker, number

  void take_agents();
  void take_triggers(double now);
  void take_requests(double now);

  bus::Node& node_;
  bus::Reader<v1::Agent> agents_;
  bus::Reader<v1::Trigger> triggers_;
  bus::Reader<v1::AgentEvent> events_;
  bus::Reader<v1::Request> asked_;
  bus::Reader<v1::Answer> answers_;
  bus::Writer<v1::Request> requests_;
  bus::Writer<v1::Answer> solved_;
  bus::Audit audit_{node_};
  const double begun_;  ///< [s] of the clock of step()
  std::string memory_;
  Facilitator facilitator_;
  RobotAgent robot_;
  bool awaits_ = false;  ///< the last step has sent a request to an agent
  /// The writer of each agent: an agent ends with its writer.
  std::multimap<bus::WriterId, std::uint64_t> agents_of_;
  /// Of each trigger the writers that hold it, with what each has written, the newest last.
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::vector<std::pair<bus::WriterId, Trigger>>>
      holders_;
  /// Open requests: they end with their writer.
  std::multimap<bus::WriterId, RequestId> requests_of_;
};

}  // namespace saphira::agent_interface
