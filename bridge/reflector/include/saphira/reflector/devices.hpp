#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "saphira/protocol/command.hpp"
#include "saphira/protocol/information.hpp"

namespace saphira::reflector {

/// Sends device commands until the robot's state shows them (manual 5.1.3): digital output,
/// position servo, origin. What no packet shows is sent three times where that does no harm
/// (polling, gripper), and once where a second one would mean something else (timer).
class Devices {
 public:
  static constexpr double kRetry = 0.2;  ///< [s]
  static constexpr int kTries = 25;      ///< then it is given up: 5 s

  void connect() { waiting_.clear(); }
  /// A newer command of the same kind takes the place of an older one.
  void request(const protocol::Command& command);
  /// A packet came. `origin`: its raw pose is (0, 0, 0) within what a moving robot makes of it.
  void reflect(const protocol::InformationPacket& packet, bool origin);
  std::vector<protocol::Command> due(double now);
  bool pending(double now) const;

  /// A command that was given up since the last call, in words.
  std::optional<std::string> take_trouble();

 private:
  struct Item {
    protocol::Command command;
    int tries = 0;
    double at = 0.0;
  };
  std::vector<Item> waiting_;
  std::optional<std::string> trouble_;
};

}  // namespace saphira::reflector
