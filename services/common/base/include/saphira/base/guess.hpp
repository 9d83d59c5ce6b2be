#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace saphira {

/// The candidate that a person may have meant by a mistyped `word`: the one that the fewest letters
/// left out, added, replaced or swapped lead to, where these are no more than a third of it, or
/// that begins with it. Empty where none is so near; of several the first.
std::string guess(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace saphira
