#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace saphira {

/// The candidate nearest to a mistyped `word`, by the number of letters left out, added, replaced
/// or swapped (optimal string alignment). At most a third of the letters may differ. Without such a
/// candidate, the first that begins with the word; empty if there is none.
std::string guess(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace saphira
