#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "behavior.h"
#include "intention.h"
#include "motion.h"
#include "robot.h"

namespace saphira::cli {

/// What is known of one cycle N of the robot. What is not known is left empty.
struct Scene {
  std::uint64_t cycle = 0;
  std::optional<v1::RobotState> robot;       ///< of N: what the behaviors saw
  std::optional<v1::Grant> grant;            ///< that let the command for N pass
  std::optional<v1::Behaviors> behaviors;    ///< of N
  std::optional<v1::Intentions> intentions;  ///< of N-1: what the behaviors made true
  std::vector<v1::Goal> goals;               ///< as far as their requesters are still there
  std::vector<v1::GoalStatus> statuses;      ///< the newest
  std::vector<v1::BehaviorSchema> schemas;   ///< for the rules as they are written
  std::string missing;                       ///< services that are not on the bus, in words
  std::string suspended;                     ///< processes that are suspended, in words
};

/// Something that is so, and what makes it so.
struct Cause {
  std::string
      kind;  ///< wheels, grant, guard, speed, turn, behavior, rule, intention, goal, trouble
  std::string text;
  std::vector<Cause> because;
};

struct Explanation {
  std::uint64_t epoch = 0;
  std::uint64_t cycle = 0;
  std::string sentence;
  Cause cause;
};

/// Why the robot's wheels do what they do: from the command back over grant, blend, behavior, rule
/// and intention to the goal and who asked for it (the intention display's purpose, paper 3.5).
Explanation why(const Scene& scene);

enum class Wish { turn_left, turn_right, faster, slower };
/// "turn left", "turn right", "faster", "slower"; nothing where it is none of these.
std::optional<Wish> parse_wish(const std::vector<std::string>& words);

/// Why it does not do that: who would have wanted it, and what spoke against it.
Explanation why_not(const Scene& scene, Wish wish);

/// The sentence, and below it the tree.
std::string to_text(const Explanation& explanation);
/// One JSON object on one line: epoch, cycle, sentence, tree {kind, text, because}.
std::string to_json(const Explanation& explanation);

}  // namespace saphira::cli
