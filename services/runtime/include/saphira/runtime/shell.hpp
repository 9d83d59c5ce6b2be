#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "saphira/base/archive.hpp"
#include "saphira/base/process.hpp"
#include "saphira/idl/common.hpp"
#include "saphira/runtime/ports.hpp"
#include "saphira/runtime/processes.hpp"

namespace saphira::runtime {

/// The present step, for every service.
struct Turn {
  v1::Stamp stamp;
  const v1::RobotState& robot;
  const v1::RobotDescription& description;
  bool new_robot = false;  ///< the first step of an epoch: another connection, maybe another robot
  bool new_frame = false;  ///< the odom frame has another origin than in the step before
};

/// A service on the bus: a core behind its ports. It converts, and decides nothing; its constructor
/// takes inputs and outputs from Ports. The shell does everything else.
class Service {
 public:
  virtual ~Service() = default;

  /// The core's micro-tasks.
  virtual ProcessTable& processes() = 0;
  /// Handles interrupt and resume for a name that is no process's: empty where done, the reason
  /// where not; nothing for an unknown name.
  virtual std::optional<std::string> ask(const std::string& /*name*/, ProcessAction /*action*/,
                                         std::uint32_t /*cycles*/) {
    return std::nullopt;
  }

  /// One cycle: inputs, the core's step, outputs. The output that moves the robot is written first.
  virtual void step(const Turn& turn) = 0;
  /// Takes inputs that need no cycle, and publishes the changes by requests; `silence` [s] since
  /// the newest step.
  virtual void between(double /*silence*/) {}
  /// Checks the files that people edit while the robot drives. Called once a second, after a step;
  /// in lockstep, where cycles are short, every hundred.
  virtual void check_files() {}

  /// Its core's whole state, and the return to it by a new core: std::runtime_error where the text
  /// does not fit, as of another version; then the present core stays.
  virtual std::string save() const { return "null"; }
  virtual void restore(std::string_view /*state*/) {}

 protected:
  template <class Core, class... Settings>
  static void renew(std::optional<Core>& core, std::string_view state,
                    const Settings&... settings) {
    saphira::restore(state, *std::make_unique<Core>(settings...));
    core.emplace(settings...);  // at its place: it is referred to
    saphira::restore(state, *core);
  }
};

/// The one shell of all cyclic services: it chooses the next cycle and its inputs (bus::Cycle),
/// keeps epochs and odom frames, the processes, the status and the log. While another program of
/// its name serves the robot, it waits; then it makes the service anew, since files and state on
/// the bus are the other one's by then.
///
/// To be made and used in one thread. It steps by itself (run), or takes turns with others in a
/// thread (advance, idle).
class Shell {
 public:
  using Make = std::function<std::unique_ptr<Service>(Ports&)>;

  /// Throws the service's exceptions for its options and files.
  Shell(bus::Node& node, Make make);
  Shell(const Shell&) = delete;
  Shell& operator=(const Shell&) = delete;

  /// Steps until stop is requested.
  void run(const bus::Stop& stop) {
    while (step(stop)) {
    }
  }
  /// Waits for one cycle and steps it; false when stop was requested.
  bool step(const bus::Stop& stop);
  /// Steps the cycle that is due, if any. Never waits.
  bool advance();
  /// Without a due step: requests, files and status. At most every 5 ms.
  void idle();

  const Ports& ports() const { return life_->ports; }
  Service& service() { return *life_->service; }

 private:
  using Clock = std::chrono::steady_clock;

  struct Life {
    Life(bus::Node& node, const Make& make);

    bus::Cycle cycle;
    Ports ports;
    std::unique_ptr<Service> service;
    ProcessesOnBus processes;
  };

  void begin();
  void step_now(const bus::Step& step);
  void between();
  void check_files();

  bus::Node& node_;
  Make make_;
  std::unique_ptr<Life> life_;
  std::optional<std::uint64_t> odom_;  ///< of the newest step of this epoch
  std::uint64_t steps_ = 0;
  Clock::time_point stepped_ = Clock::now();
  Clock::time_point checked_files_ = Clock::now();
};

}  // namespace saphira::runtime
