#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "saphira/situation/situation.hpp"

namespace saphira::situation {

/// A fact, and its causes.
struct Cause {
  std::string kind;  ///< wheels, motors, grant, guard, speed, turn, behavior, rule, intention,
                     ///< belief, goal, registration, program, trouble, zone, limit, age
  std::string text;
  std::vector<Cause> because = {};
};

struct Explanation {
  std::uint64_t epoch = 0;
  std::uint64_t cycle = 0;
  std::string sentence;
  Cause cause;
};

/// The reasons for the motion of the robot's wheels: from the command back over grant, blend,
/// behavior, rule and intention to the goal and its requester (the intention display's purpose,
/// paper 3.5).
Explanation why(const Situation& situation);

enum class Wish { turn_left, turn_right, faster, slower };
/// "turn left", "turn right", "faster", "slower"; nothing for other words.
std::optional<Wish> parse_wish(const std::vector<std::string>& words);

/// The reasons against a motion: the behaviors that wanted it, and the obstacle to it.
Explanation why_not(const Situation& situation, Wish wish);

/// The sentence, with the tree below.
std::string to_text(const Explanation& explanation);
/// One JSON object on one line: epoch, cycle, sentence, tree {kind, text, because}.
std::string to_json(const Explanation& explanation);

}  // namespace saphira::situation
