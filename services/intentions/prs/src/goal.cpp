#include "saphira/intentions/goal.hpp"

#include <cstdio>

namespace saphira::intentions {

const char* name_of(GoalState state) {
  switch (state) {
    case GoalState::kWaiting:
      return "waiting";
    case GoalState::kRefused:
      return "refused";
    case GoalState::kUnderway:
      return "underway";
    case GoalState::kSuspended:
      return "suspended";
    case GoalState::kSucceeded:
      return "succeeded";
    case GoalState::kFailed:
      return "failed";
    case GoalState::kCanceled:
      return "canceled";
  }
  return "?";
}

const char* name_of(GoalCode code) {
  switch (code) {
    case GoalCode::kNone:
      return "none";
    case GoalCode::kUnknownFunctor:
      return "unknown_functor";
    case GoalCode::kBadArgument:
      return "bad_argument";
    case GoalCode::kChanged:
      return "changed";
    case GoalCode::kTooMany:
      return "too_many";
    case GoalCode::kForgotten:
      return "forgotten";
    case GoalCode::kDeadline:
      return "deadline";
    case GoalCode::kBlocked:
      return "blocked";
    case GoalCode::kNoRobot:
      return "no_robot";
    case GoalCode::kNoPosition:
      return "no_position";
    case GoalCode::kNoRoute:
      return "no_route";
    case GoalCode::kActivity:
      return "activity";
    case GoalCode::kTimeout:
      return "timeout";
    case GoalCode::kDisposed:
      return "disposed";
    case GoalCode::kWriterLost:
      return "writer_lost";
    case GoalCode::kPreempted:
      return "preempted";
  }
  return "?";
}

std::string describe(const GoalId& id) {
  char text[48];
  std::snprintf(text, sizeof text, "%llx:%llu", static_cast<unsigned long long>(id.writer),
                static_cast<unsigned long long>(id.number));
  return text;
}

}  // namespace saphira::intentions
