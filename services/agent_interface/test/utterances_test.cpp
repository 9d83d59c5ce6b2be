#include <gtest/gtest.h>

#include <sstream>

#include "process.hpp"
#include "saphira/agent_interface/grammar.hpp"

namespace saphira::agent_interface {
namespace {

/// The shipped grammar and what people may say to it: "utterance => meaning", where the meaning is
/// a functor with its slots, `what?`, `nothing` for what is not meant for the robot, or
/// `ambiguous`.
TEST(Utterances, MeanWhatAPersonWouldTakeThemFor) {
  const std::string file = test::source("config/grammars/flakey.grammar");
  const Grammar grammar(read_file(file), file);
  std::istringstream lines(read_file(test::source("services/agent_interface/test/utterances.txt")));
  int count = 0;
  bool replies = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') {
      replies = line == "# Where the robot has asked";
      continue;
    }
    const std::size_t arrow = line.find(" => ");
    ASSERT_NE(arrow, std::string::npos) << line;
    const Grammar::Understood understood = grammar.understand(line.substr(0, arrow), replies);
    std::string meant = understood.addressed ? "what?" : "nothing";
    if (understood.meanings.size() == 1)
      meant = describe(understood.meanings.front());
    else if (understood.meanings.size() > 1)
      meant = "ambiguous";
    EXPECT_EQ(meant, line.substr(arrow + 4)) << line.substr(0, arrow);
    ++count;
  }
  EXPECT_GE(count, 250);
}

}  // namespace
}  // namespace saphira::agent_interface
