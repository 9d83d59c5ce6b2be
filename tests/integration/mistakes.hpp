#pragma once

#include <string>
#include <vector>

namespace saphira::test {

/// A mistake in a newcomer's command.
struct Mistake {
  std::vector<std::string> words;  ///< after `saphira`
  std::vector<std::string> said;   ///< parts of the answer: the error, and the advice
};

const std::vector<Mistake>& mistakes();

}  // namespace saphira::test
