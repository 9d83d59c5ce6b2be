#pragma once

#include <string>
#include <vector>

namespace saphira::test {

/// Something that a newcomer types wrongly.
struct Mistake {
  std::vector<std::string> words;  ///< behind `saphira`
  std::vector<std::string> said;   ///< parts of the answer: what was wrong, and what to do
};

const std::vector<Mistake>& mistakes();

}  // namespace saphira::test
