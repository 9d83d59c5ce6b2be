#pragma once

#include "saphira/idl/goal_end.hpp"

/// Words and order of the contract's values. In its namespace, so that a call needs none.
namespace saphira::v1 {

inline bool operator<(const GoalId& a, const GoalId& b) {
  return a.writer != b.writer ? a.writer < b.writer : a.number < b.number;
}

/// Not name_of: by that name the contract gives GOAL_WAITING.
inline const char* word_of(GoalState state) {
  switch (state) {
    case GOAL_WAITING:
      return "waiting";
    case GOAL_REFUSED:
      return "refused";
    case GOAL_UNDERWAY:
      return "underway";
    case GOAL_SUSPENDED:
      return "suspended";
    case GOAL_SUCCEEDED:
      return "succeeded";
    case GOAL_FAILED:
      return "failed";
    case GOAL_CANCELED:
      return "canceled";
  }
  return "?";
}

}  // namespace saphira::v1
