#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/base/stop_id.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/intentions/goal.hpp"
#include "saphira/intentions/value.hpp"

namespace saphira::intentions {

/// The progress of a begun goal.
struct GoalWork {
  GoalId id;
  std::string functor;
  Value intentions;  ///< as Forest::save gives it

  bool operator==(const GoalWork&) const = default;
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
  StopId heeds{};  ///< the newest stop that has ended goals

  bool operator==(const Work&) const = default;
};

/// A line for each, with its line break:
///   (at epoch cycle odom now)
///   (goal writer(hex) number functor intentions)
///   (belief name value said_by since)
///   (heeds asker(hex) number)                    where there was a stop
std::string write_work(const Work& work);
/// FileError for any other text.
Work read_work(const std::string& file, std::string_view text);

}  // namespace saphira::intentions
