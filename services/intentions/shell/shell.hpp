#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/shell/processes.hpp"
#include "intentions/shell/memory_file.hpp"
#include "saphira/bus/cycle.hpp"
#include "saphira/intentions/executor.hpp"

namespace saphira::intentions {

struct ShellOptions {
  std::string memory_file;  ///< what outlives the service; empty: nothing does
  /// Whether there is a registration service: in lockstep its samples are waited for. Without it,
  /// what is on a map cannot be found.
  bool registration = true;
};

/// The intentions service on the bus. To be made and run in one thread.
class Shell {
 public:
  /// Throws FileError or std::runtime_error where the memory file cannot be read or written.
  explicit Shell(bus::Node& node, const ShellOptions& options = {});

  /// Steps until stop is requested.
  void run(const bus::Stop& stop) {
    while (step(stop)) {
    }
  }
  /// Waits for one cycle and steps it; false when stop was requested.
  bool step(const bus::Stop& stop);

 private:
  using Clock = std::chrono::steady_clock;

  /// What somebody asks of an intention, named by its instance or number.
  std::optional<std::string> ask_intention(const std::string& name, ProcessAction action,
                                           std::uint32_t cycles);

  std::vector<GoalEvent> take_events();
  void idle();
  void publish(const News& news);

  bus::Node& node_;
  bus::Cycle cycle_;
  bus::Input<v1::Behaviors>& behaviors_;
  bus::Input<v1::Registration>* registration_;  ///< null where there is no such service
  bus::Reader<v1::Goal> goals_;
  bus::Writer<v1::Intentions> intentions_;
  bus::Writer<v1::Intentions> recall_;
  bus::Writer<v1::GoalStatus> statuses_;
  MemoryFile memory_;
  Executor executor_;
  std::vector<IntentionNode> nodes_;  ///< of the newest step
  ProcessTable table_;
  /// Suspended it lets nothing be intended: the goals are suspended, and the robot is released.
  Process& execution_ =
      table_.add("execute-intentions", "pursues the goals: begins and steps intentions");
  ProcessesOnBus processes_;
  std::map<GoalId, bus::WriterId> writers_;  ///< who wrote each goal last
  std::map<GoalId, GoalState> logged_;
  v1::Stamp stamp_;  ///< of the newest step
  Clock::time_point stepped_ = Clock::now();
  bool robot_here_ = false;
};

}  // namespace saphira::intentions
