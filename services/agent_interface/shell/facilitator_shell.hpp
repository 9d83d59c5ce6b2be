#pragma once

#include <map>

#include "saphira/agent_interface/facilitator.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::agent_interface {

/// The facilitator on the bus. For the node's own thread.
class FacilitatorShell {
 public:
  explicit FacilitatorShell(bus::Node& node);

  /// Takes the inputs and sends the outputs. now: [s] of a clock that never goes back.
  void step(double now);
  void run(const bus::Stop& stop);

 private:
  void take_agents();
  void take_triggers(double now);

  bus::Node& node_;
  bus::Reader<v1::Agent> agents_;
  bus::Reader<v1::Trigger> triggers_;
  bus::Reader<v1::AgentEvent> events_;
  bus::Reader<v1::Request> asked_;
  bus::Reader<v1::Answer> answers_;
  bus::Writer<v1::Request> requests_;
  bus::Writer<v1::Answer> solved_;
  Facilitator facilitator_;
  bool awaits_ = false;  ///< the last step has sent a request to an agent
  /// The writer of each agent: an agent ends with its writer.
  std::multimap<bus::WriterId, std::uint64_t> agents_of_;
  std::multimap<bus::WriterId, std::pair<std::uint64_t, std::uint64_t>> triggers_of_;
};

}  // namespace saphira::agent_interface
