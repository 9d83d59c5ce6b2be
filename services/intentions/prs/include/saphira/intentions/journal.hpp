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

/// The end of a goal, saved over a restart so that the service never does a goal twice.
struct Ending {
  GoalId id;
  GoalState state = v1::GOAL_SUCCEEDED;
  GoalCode code = v1::CODE_NONE;
  std::string reason;

  bool operator==(const Ending&) const = default;
};

/// Place and time of a goal's acceptance. After a restart of the service its points are the same,
/// also those given from the robot, and its deadline continues.
struct Placement {
  struct Point {
    std::string name;
    Pose given;    ///< as in the request
    Pose in_odom;  ///< its place in odom

    bool operator==(const Point&) const = default;
  };
  GoalId id;
  std::uint64_t epoch = 0;  ///< of acceptance
  std::uint64_t cycle = 0;
  std::uint64_t odom = 0;
  std::vector<Point> points;

  bool operator==(const Placement&) const = default;
};

/// Letters of an ending's reason that are saved: thousands of goals may be refused with a list of
/// all possible requests.
inline constexpr std::size_t kLongestReason = 120;
/// Endings that are saved; the oldest are dropped.
inline constexpr std::size_t kMostEndings = 8192;

/// The state that the service saves over a restart.
struct Memory {
  enum class Condition {
    kNone,     ///< nothing saved: a first start, or the file was removed
    kDamaged,  ///< a part may be missing
    kWhole
  };
  Condition condition = Condition::kNone;
  std::vector<Placement> placements;  ///< of goals that have not ended
  std::vector<Ending> endings;        ///< oldest first
  Work work;                          ///< of goals that have begun

  bool operator==(const Memory&) const = default;
};

/// Sealed lines of the journal (saphira/base/durable.hpp), with their line break.
std::string write_line(const Placement& placement);
std::string write_line(const Ending& ending);

/// Reads those lines; the newest of an id counts. Damaged lines are skipped and reported, as is a
/// last one without its line break.
Memory read_journal(const std::string& file, std::string_view content,
                    std::vector<FileError>& damaged);

}  // namespace saphira::intentions
