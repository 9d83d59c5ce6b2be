#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace saphira::situation {

/// A sentence that a person can take in at once is shorter than this.
inline constexpr std::size_t kLongestSentence = 200;

/// Puts parts together, in their order. Where that would be too long, the less important ones are
/// said shorter, and then left out.
class Sentence {
 public:
  /// `rank` 0 is never left out; `brief` says the same in fewer words (empty: there are none).
  void add(int rank, std::string text, std::string brief = {});
  /// Ends with a period.
  std::string text() const;

 private:
  struct Part {
    int rank;
    std::string text;
    std::string brief;
  };
  std::vector<Part> parts_;
};

/// The text, cut to so many characters at a word, with "..." where something is missing.
std::string cut(const std::string& text, std::size_t most);

}  // namespace saphira::situation
