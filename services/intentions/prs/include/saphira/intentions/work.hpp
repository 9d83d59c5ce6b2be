#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "saphira/base/archive.hpp"
#include "saphira/base/archived.hpp"
#include "saphira/idl/common.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/intentions/goal.hpp"
#include "saphira/intentions/requester.hpp"
#include "saphira/intentions/schema.hpp"

namespace saphira::intentions {

/// A goal of the executor.
struct GoalEntry {
  Goal goal;            ///< as written, to tell a change from a repetition
  Arguments arguments;  ///< complete; points in odom once `placed`
  std::shared_ptr<const Schema> schema;
  bool fresh = true;  ///< no step since it was heard: acceptance counts from the next step
  bool placed = false;
  bool changed = false;               ///< begun, and its activity does not know yet
  bool replaced = false;              ///< the goals that it replaces have been ended
  bool unapproved = false;            ///< waits for Executor::approve()
  std::optional<std::uint64_t> odom;  ///< the frame of its points; none: it has no points
  std::uint64_t order = 0;
  Ticks accepted = 0;
  Ticks ended = 0;
  std::uint32_t node = 0;  ///< root of its tree; 0: not begun
  GoalStatus status;
  Requester requester;  ///< the program that asked for it
  bool before = false;  ///< it was accepted before a restart of the service
  std::string refusal;  ///< of the newest change, which was rejected; empty: none
  GoalCode refusal_code = v1::CODE_NONE;
  std::optional<GoalStatus> published;
  Ticks published_at = 0;
  std::deque<double> levels;  ///< of the last cycles, for the trend
  Saved tree;                 ///< of the Forest, for a restart

  bool open() const { return !v1::ended(status.state); }
  /// Neither a stop nor a goal beside the driving one.
  bool drives() const { return !schema->concurrent && !schema->replaces; }

  bool operator==(const GoalEntry&) const = default;

  SAPHIRA_ARCHIVE(goal, arguments, fresh, placed, changed, replaced, unapproved, odom, order,
                  accepted, ended, node, status, requester, before, refusal, refusal_code,
                  published, published_at, levels, tree)
};

/// The progress of all open goals, and the values set by activities: the memory for a restart of
/// the service.
struct Work {
  std::uint64_t epoch = 0;  ///< time of this state; 0: unknown
  std::uint64_t cycle = 0;
  std::uint64_t odom = 0;
  Ticks now = 0;  ///< the clocks continue as well: activities may remember times
  Ticks awake = 0;
  std::uint32_t last_intention = 0;  ///< the newest number
  std::map<GoalId, GoalEntry> goals{};
  std::vector<Belief> beliefs{};
  std::optional<v1::StopId> heeds{};  ///< Stops::heeds()
  bool placed = false;                ///< it was known where the robot is on the map
  std::optional<GoalId> ended{};      ///< the newest ending: a list without it has lost its end

  bool operator==(const Work&) const = default;
};

/// The end of a goal, saved over a restart so that the service never does a goal twice.
struct Ending {
  GoalId id;
  GoalState state = v1::GOAL_SUCCEEDED;
  GoalCode code = v1::CODE_NONE;
  std::string reason;

  bool operator==(const Ending&) const = default;
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
  std::vector<Ending> endings;  ///< oldest first
  Work work;                    ///< of the other goals

  bool operator==(const Memory&) const = default;
};

}  // namespace saphira::intentions
