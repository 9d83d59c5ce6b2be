#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "saphira/runtime/processes.hpp"
#include "saphira/runtime/service.hpp"

namespace saphira::runtime {

/// The one shell of all cyclic services: it chooses the next cycle and its inputs (bus::Cycle),
/// keeps epochs and odom frames, the processes, the status and the log.
///
/// To be made and used in one thread. It steps by itself (run), or takes turns with others in a
/// thread (advance, idle).
class Shell {
 public:
  using Make = std::function<std::unique_ptr<Service>(Ports&)>;

  /// Throws the service's exceptions for its options and files.
  Shell(bus::Node& node, const Make& make);
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

  const Ports& ports() const { return ports_; }

 private:
  using Clock = std::chrono::steady_clock;

  void step_now(const bus::Step& step);
  void between();
  void look();

  bus::Node& node_;
  bus::Cycle cycle_;
  Ports ports_;
  std::unique_ptr<Service> service_;
  ProcessesOnBus processes_;
  std::optional<std::uint64_t> odom_;  ///< of the newest step of this epoch
  std::uint64_t steps_ = 0;
  Clock::time_point stepped_ = Clock::now();
  Clock::time_point looked_ = Clock::now();
};

}  // namespace saphira::runtime
