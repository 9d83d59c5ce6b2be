#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace saphira::situation {

/// The length limit of an easily read sentence.
inline constexpr std::size_t kLongestSentence = 200;

/// Joins parts, in order. To fit the limit, less important parts are shortened, and then left out.
class Sentence {
 public:
  /// `rank` 0 is never left out; `brief` is a shorter form (empty: none).
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

/// The text, cut to that many characters at a word, with "..." for the missing part.
std::string cut(const std::string& text, std::size_t most);

}  // namespace saphira::situation
