#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "behavior_parameters.hpp"
#include "saphira/base/archived.hpp"
#include "saphira/intentions/forest.hpp"

namespace saphira::intentions {

inline constexpr const char* kBehaviorControl = "*behavior-control*";
inline constexpr const char* kMustNotDrive = "a concurrent activity does not drive";

/// One intention: an activity, or a behavior that it has begun.
struct Forest::Node {
  IntentionNode shown;
  std::unique_ptr<Activity> activity;  ///< none: a behavior
  std::vector<std::uint32_t> children;
  std::uint32_t root = 0;
  std::size_t depth = 0;
  bool concurrent = false;  ///< must not drive, like its root
  unsigned holds = 0;
  bool suspended = false;  ///< by its own holds or with its parent
  Ticks suspended_at = 0;
  Ticks timeout = 0;
  Ticks begun = 0;
  std::optional<double> level;
  Outcome outcome;
  Bindings given;  ///< arguments from another intention; points from the robot are in odom
  // Of a behavior.
  std::string label;
  IntendedBehavior behavior;
  BehaviorParameters parameters;  ///< the source of those of `behavior`
  bool until_satisfied = false;
  Ticks since = 0;  ///< time of the intent of its parameters
  // Of an activity.
  double progress = 0.0;
  Ticks stepped = -1;                  ///< time of the newest step
  bool gone = false;                   ///< removed, in the course of a step
  std::optional<std::string> trouble;  ///< with a behavior of its own

  SAPHIRA_ARCHIVE(shown, children, root, depth, concurrent, holds, suspended, suspended_at, timeout,
                  begun, level, outcome, given, label, behavior, parameters, until_satisfied, since,
                  progress, stepped, trouble)
};

}  // namespace saphira::intentions
