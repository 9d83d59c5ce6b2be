#pragma once

#include <string>
#include <vector>

#include "saphira/situation/situation.hpp"

/// The table of situations (docs/situations.md).
namespace saphira::situation::test {

struct Case {
  std::string words;     ///< the situation, for people
  std::string question;  ///< why, why not turn left, why tree, drive, trouble
  Situation situation;
  std::vector<std::string> must;      ///< parts of the answer
  std::vector<std::string> must_not;  ///< no parts of it
};

/// Normal operation, and people driving.
std::vector<Case> good_cases();
/// Missing, slow, or past samples.
std::vector<Case> bad_cases();
/// Both.
std::vector<Case> all_cases();

/// The sentences in the situation.
std::string answer(const Case& one);
/// The errors in the answer; empty: none.
std::vector<std::string> faults(const Case& one);
/// All as one table.
std::string to_markdown(const std::vector<Case>& cases);

}  // namespace saphira::situation::test
