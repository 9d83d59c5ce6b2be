#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/intentions/beliefs.hpp"
#include "saphira/intentions/goal.hpp"
#include "saphira/intentions/value.hpp"

namespace saphira::intentions {

/// The progress of a goal that has begun.
struct GoalWork {
  GoalId id;
  std::string functor;
  Value intentions;  ///< as Forest::save gives it

  bool operator==(const GoalWork&) const = default;
};

/// The progress of all open goals, and the values that activities have set: the memory that the
/// service goes on from after a restart.
struct Work {
  std::uint64_t epoch = 0;  ///< when it was so; 0: nothing is known
  std::uint64_t cycle = 0;
  std::uint64_t odom = 0;
  Ticks now = 0;  ///< the clock goes on as well: activities may remember times
  std::vector<GoalWork> goals;
  std::vector<Belief> beliefs;

  bool operator==(const Work&) const = default;
};

/// A line for each, with its line break:
///   (at epoch cycle odom now)
///   (goal writer(hex) number functor intentions)
///   (belief name value said_by since)
std::string write_work(const Work& work);
/// FileError for what is none.
Work read_work(const std::string& file, std::string_view text);

}  // namespace saphira::intentions
