#include "saphira/speech/agreement.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <string_view>

namespace saphira::speech {
namespace {

constexpr std::size_t kKeyword = 8;  // sounds of a keyword

constexpr std::array<std::string_view, 26> kTurning{
    "not",   "never", "no",      "without", "unless",   "except", "nobody", "none",   "don't",
    "won't", "can't", "doesn't", "isn't",   "didn't",   "if",     "when",   "until",  "while",
    "was",   "were",  "maybe",   "perhaps", "probably", "almost", "longer", "nothing"};

/// Without apostrophes, which the grammar may leave out.
bool has(const std::vector<std::string>& words, std::string_view word) {
  const auto letters = [](std::string_view text) {
    std::string without(text);
    std::erase(without, '\'');
    return without;
  };
  return std::ranges::any_of(
      words, [&](const std::string& each) { return letters(each) == letters(word); });
}

}  // namespace

double difference(const std::vector<std::string>& heard, const std::vector<std::string>& command) {
  if (command.empty())
    return 0.0;
  // The edits from each beginning of `heard` to each beginning of `command`. The first sounds of
  // `heard` cost nothing.
  std::vector<std::size_t> edits(command.size() + 1);
  std::iota(edits.begin(), edits.end(), 0U);
  for (std::size_t i = 1; i <= heard.size(); ++i) {
    std::size_t diagonal = edits[0];
    edits[0] = i <= kKeyword ? 0 : i - kKeyword;
    for (std::size_t k = 1; k <= command.size(); ++k) {
      const std::size_t changed = diagonal + (heard[i - 1] == command[k - 1] ? 0 : 1);
      diagonal = edits[k];
      edits[k] = std::min({changed, edits[k] + 1, edits[k - 1] + 1});
    }
  }
  return static_cast<double>(edits.back()) / static_cast<double>(command.size());
}

bool is_turned(const std::vector<std::string>& heard, const std::vector<std::string>& command) {
  return std::ranges::any_of(
      kTurning, [&](std::string_view word) { return has(heard, word) && !has(command, word); });
}

}  // namespace saphira::speech
