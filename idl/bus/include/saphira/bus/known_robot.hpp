#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "saphira/bus/node.hpp"

namespace saphira::bus {

/// The description of the robot that a service steps for. It is written before the first state of
/// an epoch, but on another topic: it may come later. Live, there is no step until it is there; in
/// lockstep it is waited for, since what the robot does must not depend on it, unless a later epoch
/// has begun: then what is stepped concerns nobody any more.
class KnownRobot {
 public:
  explicit KnownRobot(Node& node);

  enum class Knowledge {
    none,  ///< has not come yet; the node's status says so
    same,  ///< as in the last step
    fresh  ///< the first step with this one
  };
  Knowledge of(std::uint64_t epoch, const Stop& stop);
  /// Of the newest epoch that was known.
  const v1::RobotDescription& description() const { return *description_; }

 private:
  bool take(std::uint64_t epoch);

  Node& node_;
  Reader<v1::RobotDescription> reader_;
  /// Of this bridge's last epochs, and of other bridges with a robot of the same name.
  static constexpr std::size_t kRecent = 16;
  std::deque<v1::RobotDescription> recent_;
  std::optional<v1::RobotDescription> description_;
};

}  // namespace saphira::bus
