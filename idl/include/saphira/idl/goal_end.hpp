#pragma once

#include <cstdio>
#include <string>

#include "saphira/idl/intention.hpp"

namespace saphira::v1 {

/// "1f3a:2": the id as people type it.
inline std::string describe(const GoalId& id) {
  char text[48];
  std::snprintf(text, sizeof text, "%llx:%llu", static_cast<unsigned long long>(id.writer),
                static_cast<unsigned long long>(id.number));
  return text;
}

/// True where a goal in this state has come to its end.
constexpr bool ended(GoalState state) {
  return state == GOAL_REFUSED || state == GOAL_SUCCEEDED || state == GOAL_FAILED ||
         state == GOAL_CANCELED;
}

}  // namespace saphira::v1
