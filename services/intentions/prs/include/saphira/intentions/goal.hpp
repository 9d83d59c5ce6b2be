#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/base/numbers.hpp"
#include "saphira/requests/argument.hpp"

namespace saphira::intentions {

/// Unique for ever: a writer's random number and its own count.
struct GoalId {
  std::uint64_t writer = 0;
  std::uint64_t number = 0;

  bool operator==(const GoalId&) const = default;
  bool operator<(const GoalId& other) const {
    return writer != other.writer ? writer < other.writer : number < other.number;
  }
};

enum class WriterLost { kCancel, kKeep };

/// A goal: a wanted state of the world. Writing it again under its id changes it.
struct Goal {
  GoalId id;
  std::string requester;
  std::string functor;
  Arguments arguments;
  int priority = 0;       ///< larger is more important
  double deadline = 0.0;  ///< [s] of robot time from acceptance; 0: none
  WriterLost writer_lost = WriterLost::kCancel;
  double level = 0.0;  ///< [0..1] sufficient satisfaction; 0: the default

  bool operator==(const Goal&) const = default;
};

enum class GoalState { kWaiting, kRefused, kUnderway, kSuspended, kSucceeded, kFailed, kCanceled };

enum class GoalCode {
  kNone,
  kUnknownFunctor,
  kBadArgument,
  kChanged,
  kTooMany,
  kForgotten,  ///< older than this start of the service, whose memory was lost
  kDeadline,
  kBlocked,
  kNoRobot,
  kNoPosition,
  kNoRoute,   ///< the map knows no way, or every way is blocked
  kActivity,  ///< the activity failed
  kTimeout,   ///< a part took too long
  kDisposed,
  kWriterLost,
  kPreempted,
  kStopped
};

/// Of a goal's level, over the last seconds.
enum class Trend { kSteady, kRising, kFalling };

inline constexpr bool ended(GoalState state) {
  return state == GoalState::kRefused || state == GoalState::kSucceeded ||
         state == GoalState::kFailed || state == GoalState::kCanceled;
}

/// The state of a goal.
struct GoalStatus {
  GoalId id;
  std::string requester;
  std::string functor;
  GoalState state = GoalState::kWaiting;
  GoalCode code = GoalCode::kNone;
  std::string reason;     ///< in words; always given at an end
  std::string step;       ///< the present work
  double progress = 0.0;  ///< [0..1]
  double elapsed = 0.0;   ///< [s] of robot time since acceptance
  double level = 0.0;     ///< [0..1] satisfaction
  Trend trend = Trend::kSteady;
  std::string note;  ///< further information; empty: none
  /// Waiting or suspended: the goal in front of it; canceled: the one that stopped it; 0:0: none.
  GoalId waits_for;

  bool operator==(const GoalStatus&) const = default;
};

/// The word for it in files and messages, such as "succeeded".
const char* name_of(GoalState state);
const char* name_of(GoalCode code);
/// "1f3a:2": the id as people type it.
std::string describe(const GoalId& id);

}  // namespace saphira::intentions
