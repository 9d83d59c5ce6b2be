#pragma once

#include <cstdint>

namespace saphira {

/// The sign of life of a node for the supervisor that started its process, by a pipe, whenever it
/// publishes its status: over the bus a program that is deaf could not be told from one that is
/// not heard. The pipe is named by the environment: kHeartbeatVariable is "descriptor:inode".
struct Heartbeat {
  enum Flags : std::uint64_t {
    kWaitsForRobot = 1,  ///< for robot/state, or for the robot's description
    kEnds = 2,           ///< the last one: this node ends in good order
    kWritesRobot = 4,    ///< it is the bridge: it writes robot/state
  };
  std::uint64_t instance = 0;  ///< of ServiceStatus
  std::uint64_t epoch = 0;     ///< of its newest step
  std::uint64_t cycle = 0;
  std::uint64_t flags = 0;
};

inline constexpr const char* kHeartbeatVariable = "SAPHIRA_HEARTBEAT";
/// Why the supervisor has started this program again, in words; the node logs it.
inline constexpr const char* kRestartedVariable = "SAPHIRA_STARTED_AGAIN";
/// How such a record of system/log begins.
inline constexpr const char* kStartedAgain = "started again: ";

}  // namespace saphira
