#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "saphira/situation/situation.hpp"

namespace saphira::situation {

/// Something that is so, and what makes it so.
struct Cause {
  std::string kind;  ///< wheels, grant, guard, speed, turn, behavior, rule, intention, belief,
                     ///< goal, trouble
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
Explanation why(const Situation& situation);

enum class Wish { turn_left, turn_right, faster, slower };
/// "turn left", "turn right", "faster", "slower"; nothing where it is none of these.
std::optional<Wish> parse_wish(const std::vector<std::string>& words);

/// Why it does not do that: who would have wanted it, and what spoke against it.
Explanation why_not(const Situation& situation, Wish wish);

/// The sentence, and below it the tree.
std::string to_text(const Explanation& explanation);
/// One JSON object on one line: epoch, cycle, sentence, tree {kind, text, because}.
std::string to_json(const Explanation& explanation);

}  // namespace saphira::situation
