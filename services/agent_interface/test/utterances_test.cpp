#include "utterances.hpp"

#include <gtest/gtest.h>

#include "process.hpp"

namespace saphira::agent_interface {
namespace {

/// The shipped grammar and what people may say to it.
TEST(Utterances, MeanWhatAPersonWouldTakeThemFor) {
  const std::string file = test::source("config/grammars/flakey.grammar");
  const Grammar grammar(read_file(file), file);
  const std::vector<SaidAndMeant> phrases =
      read_utterances(read_file(test::source("services/agent_interface/test/utterances.txt")));
  EXPECT_GE(phrases.size(), 250U);
  for (const SaidAndMeant& phrase : phrases)
    EXPECT_EQ(meaning_of(grammar, phrase), phrase.meaning) << phrase.text;
}

}  // namespace
}  // namespace saphira::agent_interface
