#include "saphira/watch/halt.hpp"

#include <gtest/gtest.h>

#include <map>

namespace saphira::watch {
namespace {

using News = Halt::News;

/// The news of a stop that is confirmed in that time, every 0.5 s.
std::map<double, News> news(Halt& halt, double from, double to, bool confirmed) {
  std::map<double, News> all;
  for (double now = from; now <= to; now += 0.5)
    if (const News one = halt.update(confirmed, now); one != News::none)
      all[now] = one;
  return all;
}

TEST(Halt, TellsThatItIsNotConfirmedAgainAndAgainAndGoesOn) {
  Halt halt;
  EXPECT_EQ(news(halt, 0.0, 7.0, false),
            (std::map<double, News>{{2.5, News::not_confirmed}, {5.0, News::not_confirmed}}));
  EXPECT_EQ(halt.lasts(7.0), 7.0);
  EXPECT_EQ(halt.update(false, 1000.0), News::not_confirmed);
  EXPECT_TRUE(halt.well());
}

TEST(Halt, IsSilentWhereARobotComesToRestInTime) {
  Halt halt;
  EXPECT_TRUE(news(halt, 0.0, 1.0, false).empty());
  EXPECT_TRUE(news(halt, 1.5, 6.5, true).empty());
  EXPECT_EQ(halt.lasts(6.5), 5.0);
  halt.end(v1::ANSWER_DONE);
  EXPECT_TRUE(halt.well());
}

TEST(Halt, TellsThatARobotIsNotSeenAtRestAndGivesUp) {
  Halt halt;
  EXPECT_TRUE(news(halt, 0.0, 0.5, false).empty());
  EXPECT_EQ(news(halt, 1.0, 12.0, true),
            (std::map<double, News>{
                {6.5, News::not_at_rest}, {9.0, News::not_at_rest}, {11.5, News::not_at_rest}}));
  EXPECT_EQ(halt.update(true, 31.0), News::not_at_rest);
  EXPECT_EQ(halt.update(true, 31.1), News::given_up);
  EXPECT_EQ(halt.update(true, 40.0), News::given_up);
}

// A second bridge is found, or the one that had confirmed is gone.
TEST(Halt, BeginsAnewWhereItIsNoLongerConfirmedByEach) {
  Halt halt;
  EXPECT_TRUE(news(halt, 0.0, 3.0, true).empty());
  EXPECT_EQ(news(halt, 3.5, 6.0, false), (std::map<double, News>{{6.0, News::not_confirmed}}));
  EXPECT_EQ(halt.lasts(6.0), 2.5);
  EXPECT_TRUE(news(halt, 28.0, 33.0, true).empty()) << "its rest has its whole time";
  EXPECT_EQ(halt.update(true, 58.0), News::not_at_rest);
  EXPECT_EQ(halt.update(true, 58.5), News::given_up);
}

TEST(Halt, IsWellWhereEachBridgeHasSeenItsRobotAtRest) {
  for (const v1::AnswerCode code : {v1::ANSWER_LOST, v1::ANSWER_GIVEN_UP, v1::ANSWER_REFUSED}) {
    Halt halt;
    halt.end(code);
    halt.end(v1::ANSWER_DONE);
    EXPECT_FALSE(halt.well()) << code;
  }
}

}  // namespace
}  // namespace saphira::watch
