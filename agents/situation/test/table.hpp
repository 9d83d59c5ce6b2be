#pragma once

#include <string>
#include <vector>

#include "saphira/situation/situation.hpp"

/// The table of situations (situations.txt, docs/situations.md).
namespace saphira::situation::test {

struct Case {
  std::string words;     ///< the situation, for people
  std::string question;  ///< why, why not turn left, why tree, drive, trouble
  Situation situation;
  std::vector<std::string> must;   ///< parts of the answer
  std::vector<std::string> never;  ///< no parts of it
  std::vector<std::string> once;   ///< of those, what is not repeated
  std::string says;                ///< all of it [empty: not said]
};

/// The cases of a file, in its form (test/situations.txt). std::invalid_argument, with file and
/// line, for a wrong one.
std::vector<Case> read_cases(const std::string& text, const std::string& file);

/// The sentences in the situation.
std::string answer(const Case& one);

/// The errors in an answer.
struct Faults {
  std::vector<std::string> lacks;  ///< half an answer
  std::vector<std::string> says;   ///< a false one, or one too long
};
Faults faults(const Case& one);

/// All as one table.
std::string to_markdown(const std::vector<Case>& cases);

}  // namespace saphira::situation::test
