#include "saphira/bridge/doubts.hpp"

#include <gtest/gtest.h>

namespace saphira::bridge {
namespace {

TEST(Doubts, AreShownForAWhileAndToldNowAndThen) {
  Doubts doubts;
  EXPECT_EQ(doubts.newest(0.5), "");
  EXPECT_FALSE(doubts.take_words(0.5));
  doubts.add({"sonar number 40", false}, 1.0);
  EXPECT_EQ(doubts.newest(2.9), "sonar number 40");
  EXPECT_EQ(doubts.newest(3.1), "");
  EXPECT_EQ(doubts.take_words(1.0), "sonar number 40");
  doubts.add({"a turn of 183 rad/s", true}, 1.1);
  EXPECT_EQ(doubts.newest(1.1), "a turn of 183 rad/s");
  EXPECT_FALSE(doubts.take_words(1.1)) << "ten a second would be read by nobody";
  EXPECT_EQ(doubts.take_words(11.2), "a turn of 183 rad/s");
  EXPECT_FALSE(doubts.take_words(30.0)) << "nothing new";
  EXPECT_EQ(doubts.count(), 2U);
  doubts.reset();
  EXPECT_EQ(doubts.count(), 0U);
  EXPECT_EQ(doubts.newest(11.2), "");
}

}  // namespace
}  // namespace saphira::bridge
