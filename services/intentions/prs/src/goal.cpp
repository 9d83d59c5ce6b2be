#include "saphira/intentions/goal.hpp"

#include <array>
#include <cstddef>
#include <cstdio>

namespace saphira::intentions {

namespace {

constexpr std::array<const char*, 7> kStates{"waiting",   "refused", "underway", "suspended",
                                             "succeeded", "failed",  "canceled"};
static_assert(kStates.size() == static_cast<std::size_t>(GoalState::kCanceled) + 1);
constexpr std::array<const char*, 17> kCodes{
    "none",     "unknown_functor", "bad_argument", "changed",     "too_many", "forgotten",
    "deadline", "blocked",         "no_robot",     "no_position", "no_route", "activity",
    "timeout",  "disposed",        "writer_lost",  "preempted",   "stopped"};
static_assert(kCodes.size() == static_cast<std::size_t>(GoalCode::kStopped) + 1);

template <class Names, class Enum>
const char* name_in(const Names& names, Enum value) {
  const auto index = static_cast<std::size_t>(value);
  return index < names.size() ? names[index] : "?";
}

}  // namespace

const char* name_of(GoalState state) {
  return name_in(kStates, state);
}

const char* name_of(GoalCode code) {
  return name_in(kCodes, code);
}

std::string describe(const GoalId& id) {
  char text[48];
  std::snprintf(text, sizeof text, "%llx:%llu", static_cast<unsigned long long>(id.writer),
                static_cast<unsigned long long>(id.number));
  return text;
}

}  // namespace saphira::intentions
