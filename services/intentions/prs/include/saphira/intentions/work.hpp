#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saphira/base/archive.hpp"
#include "saphira/idl/common.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/intentions/goal.hpp"

namespace saphira::intentions {

/// The progress of a begun goal.
struct GoalWork {
  GoalId id;
  std::string functor;
  Arguments arguments;      ///< as written
  bool unapproved = false;  ///< changed since, and waits for a person's approval
  Saved intentions;         ///< of the Forest

  bool operator==(const GoalWork&) const = default;

  /// True while the goal has the functor and the arguments with which the work began.
  bool is_of(const Goal& goal) const {
    return id == goal.id && functor == goal.functor && arguments == goal.arguments;
  }
};

/// The progress of all open goals, and the values set by activities: the memory for a restart of
/// the service.
struct Work {
  std::uint64_t epoch = 0;  ///< time of this state; 0: unknown
  std::uint64_t cycle = 0;
  std::uint64_t odom = 0;
  Ticks now = 0;  ///< the clock continues as well: activities may remember times
  std::vector<GoalWork> goals;
  std::vector<Belief> beliefs;
  v1::StopId heeds{};   ///< the newest stop that has ended goals
  bool placed = false;  ///< it was known where the robot is on the map

  bool operator==(const Work&) const = default;
};

}  // namespace saphira::intentions
