#include <gtest/gtest.h>

#include "saphira/situation/words.hpp"

namespace saphira::situation {
namespace {

TEST(Sentence, HoldsAllWhereItFits) {
  Sentence sentence;
  sentence.add(0, "It stands");
  sentence.add(3, ": nobody asks");
  sentence.add(1, "");
  EXPECT_EQ(sentence.text(), "It stands: nobody asks.");
}

TEST(Sentence, SaysTheLessImportantShorterAndThenNotAtAll) {
  Sentence sentence;
  sentence.add(0, std::string(150, 'a'));
  sentence.add(2, " " + std::string(60, 'b'), " b");
  sentence.add(1, " c");
  EXPECT_EQ(sentence.text(), std::string(150, 'a') + " b c.");
  sentence.add(3, std::string(100, 'd'));
  EXPECT_EQ(sentence.text(), std::string(150, 'a') + " b c.");
}

TEST(Sentence, IsNeverLongerThanItMayBe) {
  Sentence sentence;
  sentence.add(0, std::string(300, 'a'));
  EXPECT_LT(sentence.text().size(), kLongestSentence);
  EXPECT_TRUE(sentence.text().ends_with("a....")) << sentence.text();
}

TEST(Cut, EndsAtAWord) {
  EXPECT_EQ(cut("one two three", 13), "one two three");
  EXPECT_EQ(cut("one two three", 12), "one two...");
  EXPECT_EQ(cut("aaaaaaaaaaaaaaaaaaaa", 10), "aaaaaaa...");
}

}  // namespace
}  // namespace saphira::situation
