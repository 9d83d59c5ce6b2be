#pragma once

#include <cstdint>
#include <optional>

#include "saphira/bus/cycle.hpp"
#include "saphira/bus/known_robot.hpp"
#include "saphira/interpretation/interpretation.hpp"

namespace saphira::interpretation {

/// The interpretation service on the bus. To be made and run in one thread.
class Shell {
 public:
  explicit Shell(bus::Node& node);

  /// Steps until stop is requested.
  void run(const bus::Stop& stop) {
    while (step(stop)) {
    }
  }
  /// Waits for one cycle and steps it; false when stop was requested.
  bool step(const bus::Stop& stop);

 private:
  bus::Node& node_;
  bus::Cycle cycle_;
  bus::KnownRobot robot_;
  bus::Writer<v1::Perception> perceptions_;
  std::optional<std::uint64_t> odom_;  ///< of the newest step
  Interpretation interpretation_{Settings{}};
};

}  // namespace saphira::interpretation
