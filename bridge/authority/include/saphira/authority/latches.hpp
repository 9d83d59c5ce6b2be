#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "saphira/idl/common.hpp"

namespace saphira::authority {

/// Why autonomy waits for a person.
enum class Wait {
  none,
  driven,  ///< a person drove last
  reset,   ///< an emergency stop was reset while autonomy asked to drive, or was not heard
};

/// A writer on the bus, for ever.
using WriterId = std::array<std::uint8_t, 16>;

/// The roles that may drive, strongest first.
enum class Role { none, estop, teleop, direct, behaviors };

/// A driver that the newest stop has stopped, and that has not let go since.
struct Stopped {
  Role role = Role::none;
  WriterId writer{};
  bool operator==(const Stopped&) const = default;
};

/// Stops that hold whatever happens to the programs.
struct Latches {
  bool estopped = false;       ///< until a person releases it
  std::string estop_source{};  ///< which program pressed it
  Wait wait = Wait::none;      ///< until a person hands the robot back
  v1::StopId stop{};           ///< the newest, which goals of before have to heed
  std::string stop_source{};
  std::vector<Stopped> stopped{};  ///< the newest, at most 24
  bool operator==(const Latches&) const = default;
};

}  // namespace saphira::authority
