#pragma once

#include <functional>
#include <optional>
#include <string>

#include "saphira/base/process.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::runtime {

/// A service's micro-tasks on the bus (manual 6.5, and the window of 2.3.7): tells their states,
/// and obeys who asks. For the node's own thread.
class ProcessesOnBus {
 public:
  /// What else can be asked for by a name that is none of the table's: empty where it was done,
  /// the reason where not; nothing where there is no such thing either.
  using Others = std::function<std::optional<std::string>(
      const std::string& name, ProcessAction action, std::uint32_t cycles)>;

  /// The table outlives this. Requests name the service as the node is named.
  ProcessesOnBus(bus::Node& node, ProcessTable& table, Others others = {});
  ~ProcessesOnBus();
  ProcessesOnBus(const ProcessesOnBus&) = delete;
  ProcessesOnBus& operator=(const ProcessesOnBus&) = delete;

  /// A cycle begins: takes requests, gives each process its turn, tells what has changed.
  void step(const v1::Stamp& stamp);
  /// Between cycles: takes requests and tells what has changed. The cycles may stand still.
  void idle();

 private:
  void take_requests();
  void publish();

  bus::Node& node_;
  ProcessTable& table_;
  Others others_;
  bus::Reader<v1::ProcessRequest> requests_;
  bus::Writer<v1::ProcessAnswer> answers_;
  bus::Writer<v1::Processes> states_;
  v1::Stamp stamp_;  ///< of the newest cycle
};

}  // namespace saphira::runtime
