// The answer to a newcomer's mistake at the command line gives the error and advice.
#include "mistakes.hpp"

#include <gtest/gtest.h>

#include "process.hpp"

namespace saphira {
namespace {

class Mistakes : public testing::TestWithParam<std::size_t> {};

TEST_P(Mistakes, AreAnsweredWithWhatWasWrongAndWhatToDo) {
  const test::Mistake& mistake = test::mistakes()[GetParam()];
  const test::TempDir folder;
  std::vector<std::string> words{"saphira"};
  words.insert(words.end(), mistake.words.begin(), mistake.words.end());
  // Its input is empty.
  words.insert(words.begin(), {"/bin/sh", "-c", "exec \"$0\" \"$@\" </dev/null"});
  words[3] = test::program("saphira");
  test::Process process(words, folder.path("said"), {{"SAPHIRA_ROBOT", test::unique_robot()}});
  const std::optional<int> code = process.wait();
  const std::string said = process.output();
  const std::string typed = testing::PrintToString(mistake.words);
  EXPECT_TRUE(code == 1 || code == 2) << typed << ": " << said;
  for (const std::string& part : mistake.said)
    EXPECT_NE(said.find(part), std::string::npos) << typed << ": " << said;
  // The answer names the mistake, and does not list all valid forms.
  EXPECT_LT(said.size(), 2000U) << typed;
  EXPECT_EQ(said.find("terminate"), std::string::npos) << typed << ": " << said;
}

INSTANTIATE_TEST_SUITE_P(Each, Mistakes, testing::Range<std::size_t>(0, test::mistakes().size()));

TEST(Mistakes, AreFiftyAndMore) {
  EXPECT_GE(test::mistakes().size(), 50U);
}

}  // namespace
}  // namespace saphira
