#include "saphira/speech/agreement.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace saphira::speech {
namespace {

std::vector<std::string> parts(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), std::istream_iterator<std::string>()};
}

double difference_of(const char* heard, const char* command) {
  return difference(parts(heard), parts(command));
}

TEST(Agreement, IsTheShareOfSoundsThatDiffer) {
  EXPECT_EQ(difference_of("T ER N L EH F T", "T ER N L EH F T"), 0.0);
  EXPECT_EQ(difference_of("T ER N L EH S T", "T ER N L EH F T"), 1.0 / 7.0);
  EXPECT_EQ(difference_of("", "T ER N"), 1.0);
  EXPECT_EQ(difference_of("T ER N", ""), 0.0);
}

TEST(Agreement, TheKeywordBeforeItDoesNotCount) {
  EXPECT_EQ(difference_of("F L EY K IY T ER N L EH F T", "T ER N L EH F T"), 0.0);
  EXPECT_GE(difference_of("F L EY K IY D UW N AA T EH V ER T ER N", "T ER N"), 1.0)
      << "more than a keyword";
}

TEST(Agreement, MoreWordsBehindTheCommandCount) {
  EXPECT_GT(difference_of("W EY T DH EH R AH N D G OW", "W EY T DH EH R"), 0.5);
}

TEST(Agreement, AWordThatTurnsTheMeaningIsNoticed) {
  EXPECT_TRUE(is_turned(parts("do not wait there"), parts("wait there")));
  EXPECT_TRUE(is_turned(parts("keep out until noon"), parts("keep out please")));
  EXPECT_FALSE(is_turned(parts("john doesn't know"), parts("john doesnt know")));
  EXPECT_FALSE(is_turned(parts("flake a turn left"), parts("turn left")));
}

}  // namespace
}  // namespace saphira::speech
