#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace saphira {

/// The candidate nearest to a mistyped `word`, by the number of letters left out, added, replaced
/// or swapped (optimal string alignment), whatever their case. At most a third of the letters may
/// differ. Without such a candidate, the first that begins with the word, or else the longest that
/// is the word's beginning up to a dash or underscore; empty if there is none.
std::string guess(std::string_view word, const std::vector<std::string>& candidates);

/// ": did you mean CANDIDATE?" for a message about an unknown `word`; `otherwise` where none is
/// near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates,
                         std::string_view otherwise = {});

}  // namespace saphira
