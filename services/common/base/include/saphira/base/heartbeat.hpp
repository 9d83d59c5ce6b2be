#pragma once

#include <cstdint>

namespace saphira {

/// A node's sign of life for the supervisor that started its process, by a pipe, whenever it
/// publishes its status. Over the bus a deaf program would look like one that is not heard. The
/// environment names the pipe: kHeartbeatVariable is "descriptor:inode".
struct Heartbeat {
  enum Flags : std::uint64_t {
    kWaitsForRobot = 1,  ///< for robot/state, or for the robot's description
    kEnds = 2,           ///< the last one: a clean end of this node
    kWritesRobot = 4,    ///< it is the bridge: it writes robot/state
  };
  std::uint64_t instance = 0;  ///< of ServiceStatus
  std::uint64_t epoch = 0;     ///< of its newest step
  std::uint64_t cycle = 0;
  std::uint64_t flags = 0;
};

inline constexpr const char* kHeartbeatVariable = "SAPHIRA_HEARTBEAT";
/// The reason for the supervisor's restart of this program, in words; the node logs it.
inline constexpr const char* kRestartedVariable = "SAPHIRA_STARTED_AGAIN";
/// The beginning of such a record of system/log.
inline constexpr const char* kStartedAgain = "started again: ";

}  // namespace saphira
