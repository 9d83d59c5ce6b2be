#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "saphira/behaviors/executive.hpp"
#include "saphira/bus/cycle.hpp"

namespace saphira::behaviors {

/// The behaviors service on the bus. To be made and run in one thread.
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
  void take_description();
  bool know_robot(const v1::RobotState& robot, const bus::Stop& stop);
  void wait_for_description();
  void publish(const Output& output);

  bus::Node& node_;
  bus::Cycle cycle_;
  bus::Input<v1::Intentions>& intentions_;
  bus::Reader<v1::RobotDescription> descriptions_;
  bus::Writer<v1::MotorCommand> commands_;
  bus::Writer<v1::Behaviors> behaviors_;

  std::optional<v1::RobotDescription> description_;  ///< the newest
  std::uint64_t model_epoch_ = 0;                    ///< of the description the executive has
  std::optional<std::uint64_t> odom_;                ///< of the newest step
  std::uint64_t odom_since_ = 0;                     ///< cycle in which it last changed
  Executive executive_{predefined(), RobotModel{}};
  std::uint64_t number_ = 0;  ///< of the newest motor command
  std::string trouble_;
  bool active_ = false;
};

}  // namespace saphira::behaviors
