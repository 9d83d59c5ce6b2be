#pragma once

#include <functional>
#include <optional>
#include <string>

#include "requests/shell/desk.hpp"
#include "saphira/base/process.hpp"

namespace saphira::runtime {

/// A service's micro-tasks on the bus (manual 6.5, and the window of 2.3.7): publishes their
/// states, and carries out requests. For the node's own thread.
class ProcessesOnBus {
 public:
  /// Handles requests for a name that is not in the table: empty where done, the reason where not;
  /// nothing for an unknown name.
  using Others = std::function<std::optional<std::string>(
      const std::string& name, ProcessAction action, std::uint32_t cycles)>;

  /// The table outlives this.
  ProcessesOnBus(bus::Node& node, ProcessTable& table, Others others = {});
  ~ProcessesOnBus();
  ProcessesOnBus(const ProcessesOnBus&) = delete;
  ProcessesOnBus& operator=(const ProcessesOnBus&) = delete;

  /// A cycle begins: takes requests, gives each process its turn, publishes changes.
  void step(const v1::Stamp& stamp);
  /// Between cycles: takes requests and publishes changes. The cycles may stand still.
  void idle();

 private:
  void take();
  Answer act(const Request& request);
  void publish();

  bus::Node& node_;
  ProcessTable& table_;
  Others others_;
  Desk desk_;
  bus::Writer<v1::ProcessSet> states_;
  v1::Stamp stamp_;  ///< of the newest cycle
};

}  // namespace saphira::runtime
