#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "goals.hpp"
#include "process.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/sim/trace.hpp"

namespace saphira::test {

/// A robot with its services in a test's own world, in lockstep, and a node of the test beside
/// them.
class LockstepSystem {
 public:
  struct Scene {
    std::string world;            ///< text of a world file
    std::string robot;            ///< a name of config/robots, or a file
    std::string map{};            ///< a file of config/maps [none: an empty map]
    bool vision = false;          ///< with stereo cameras and the vision service
    bool single_process = false;  ///< in one thread, without a bus between the services
  };

  explicit LockstepSystem(const Scene& scene);

  /// Asks for a goal, and waits for its arrival: before the first cycle.
  v1::GoalId ask(const v1::Goal& goal);
  /// Permits the robot's steps up to that cycle.
  void permit(std::uint64_t until);
  /// Waits for the goal's end, and calls `meanwhile` until then; returns the goal's newest status,
  /// which is no end where the goal does not end.
  std::optional<v1::GoalStatus> wait_end(
      const v1::GoalId& goal, const std::function<void()>& meanwhile = [] {});
  /// Ends the simulator, which completes its trace; returns the trace.
  std::string end();
  /// Everything that the processes have printed.
  std::string output() const;

  TempDir folder;
  std::string robot = unique_robot();
  bus::Node node;
  bus::GoalClient goals{node, "test"};

 private:
  void on_bus(std::vector<std::string> argv);
  void run(std::vector<std::string> argv);

  bus::Writer<v1::StepPermit> permits_ = node.writer(bus::topics::kStepPermit);
  std::vector<std::unique_ptr<Process>> processes_;
};

}  // namespace saphira::test
