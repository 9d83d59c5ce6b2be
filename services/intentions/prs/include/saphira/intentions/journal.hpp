#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/base/text.hpp"
#include "saphira/intentions/goal.hpp"
#include "saphira/intentions/work.hpp"

namespace saphira::intentions {

/// How a goal ended: what has to outlive the service so that it never does a goal twice.
struct Ending {
  GoalId id;
  GoalState state = GoalState::kSucceeded;
  GoalCode code = GoalCode::kNone;
  std::string reason;

  bool operator==(const Ending&) const = default;
};

/// Where and when a goal was accepted: after a restart of the service its points are still what
/// they were, also those that were given from the robot, and its deadline goes on.
struct Placement {
  struct Point {
    std::string name;
    Pose given;    ///< as it was asked for
    Pose in_odom;  ///< what became of it

    bool operator==(const Point&) const = default;
  };
  GoalId id;
  std::uint64_t epoch = 0;  ///< of acceptance
  std::uint64_t cycle = 0;
  std::uint64_t odom = 0;
  std::vector<Point> points;

  bool operator==(const Placement&) const = default;
};

/// Letters of an ending's reason that are remembered: thousands of goals may be refused with a list
/// of all that could have been asked for.
inline constexpr std::size_t kLongestReason = 120;
/// Endings that are remembered; the oldest are forgotten.
inline constexpr std::size_t kMostEndings = 8192;

/// State that the service keeps over a restart.
struct Memory {
  enum class Condition {
    kNone,     ///< nothing was remembered: a first start, or the file was removed
    kDamaged,  ///< a part may be missing
    kWhole
  };
  Condition condition = Condition::kNone;
  std::vector<Placement> placements;  ///< of goals that have not ended
  std::vector<Ending> endings;        ///< oldest first
  Work work;                          ///< of goals that have begun

  bool operator==(const Memory&) const = default;
};

/// Lines of the journal, with their line break, each behind its sum (saphira/base/durable.hpp):
///   placed writer(hex) number epoch cycle odom {name x y th x y th}
///   ended writer(hex) number state code reason...
std::string write_line(const Placement& placement);
std::string write_line(const Ending& ending);

/// Reads those lines; the newest of an id counts. Lines that are not as they were written are
/// skipped and told, as is a last one without its line break.
Memory read_journal(const std::string& file, std::string_view content,
                    std::vector<FileError>& damaged);

}  // namespace saphira::intentions
