#include "saphira/base/guess.hpp"

#include <utf8proc.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "folding.hpp"

namespace saphira {
namespace {

constexpr std::size_t kLongest = 64;  // letters: longer words are not compared

/// Without case and marks: "jose" of "José". Such words are near, and not the same.
std::string bare(std::string_view word) {
  return internal::without_case(word, UTF8PROC_DECOMPOSE | UTF8PROC_STRIPMARK);
}

/// The number of letters left out, added, replaced, or swapped with the next (optimal string
/// alignment).
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> least(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        least[i][j] = i + j;
        continue;
      }
      const std::size_t replaced = least[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      least[i][j] = std::min({least[i - 1][j] + 1, least[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        least[i][j] = std::min(least[i][j], least[i - 2][j - 2] + 1);
    }
  return least[a.size()][b.size()];
}

}  // namespace

std::string guess(std::string_view word, const std::vector<std::string>& candidates) {
  if (word.empty() || word.size() > kLongest)
    return "";
  const std::string small = bare(word);
  std::string best;
  std::size_t nearest = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongest)
      continue;
    const std::size_t far = distance(small, bare(candidate));
    if (far < nearest) {
      nearest = far;
      best = candidate;
    }
  }
  if (!best.empty() || word.size() < 2)
    return best;
  const auto longer = std::find_if(
      candidates.begin(), candidates.end(),
      [&](const std::string& candidate) { return bare(candidate).starts_with(small); });
  if (longer != candidates.end())
    return *longer;
  for (const std::string& candidate : candidates) {
    const std::string known = bare(candidate);
    if (known.size() > best.size() && small.starts_with(known) &&
        (small[known.size()] == '-' || small[known.size()] == '_'))
      best = candidate;
  }
  return best;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates,
                         std::string_view otherwise) {
  std::string meant = guess(word, candidates);
  // Words of people, and the command that begins with a candidate.
  constexpr std::array<std::array<std::string_view, 3>, 3> kSynonyms{
      {{"halt", "estop", "estop"},
       {"hand-back", "drive", "drive hand-back"},
       {"off", "reset", "reset"}}};
  for (const auto& [said, candidate, command] : kSynonyms)
    if (meant.empty() && word == said &&
        std::find(candidates.begin(), candidates.end(), candidate) != candidates.end())
      meant = command;
  return meant.empty() ? std::string(otherwise) : ": did you mean " + meant + "?";
}

}  // namespace saphira
