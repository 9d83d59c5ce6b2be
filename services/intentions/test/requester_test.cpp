#include "saphira/intentions/requester.hpp"

#include <gtest/gtest.h>

namespace saphira::intentions {
namespace {

using Turn = Requester::Turn;
constexpr v1::WriterLost kEndsWithIt = v1::WRITER_LOST_CANCEL;
constexpr v1::WriterLost kKeep = v1::WRITER_LOST_KEEP;
constexpr Ticks kBegin = 1000;

/// The ticks until the goal has a turn that is not kNone, within an hour; 0: it has none.
Ticks turns_after(Requester& requester, v1::WriterLost policy, Turn turn) {
  for (Ticks i = 1; i <= 36000; ++i)
    if (const Turn now = requester.pass(policy, kBegin + i); now != Turn::kNone) {
      EXPECT_EQ(now, turn);
      return i;
    }
  return 0;
}

Requester cut_off() {
  Requester requester;
  requester.cut_off(kBegin);
  return requester;
}
Requester recalled() {
  Requester requester;
  requester.recall(kBegin);
  return requester;
}
Requester switched_on() {
  Requester requester = recalled();
  requester.meet_bridge();
  return requester;
}

TEST(Requester, AGoalWaitsForAProgramThatIsNotHeardAndEnds) {
  Requester requester = cut_off();
  EXPECT_EQ(
      requester.why_to_wait(kEndsWithIt),
      "the program that asked for it is not heard: it goes on when that is, and ends after 10 s");
  EXPECT_EQ(turns_after(requester, kEndsWithIt, Turn::kEnds), 100);
  EXPECT_EQ(requester.why_ended(kEndsWithIt),
            "the program that asked for it is gone, or was cut off for 10 s");
  for (Requester each : {recalled(), switched_on()}) {
    EXPECT_TRUE(each.why_to_wait(kEndsWithIt).ends_with("ends after 600 s"));
    EXPECT_EQ(turns_after(each, kEndsWithIt, Turn::kEnds), 6000);
    EXPECT_EQ(
        each.why_ended(kEndsWithIt),
        "intentions was restarted, and the program that asked for it has not been heard since");
  }
}

TEST(Requester, AGoalThatIsToBeKeptGoesOnWithoutIt) {
  Requester cut = cut_off();
  EXPECT_EQ(cut.why_to_wait(kKeep), "");
  EXPECT_EQ(turns_after(cut, kKeep, Turn::kNone), 0);
  Requester left = recalled();
  EXPECT_NE(left.why_to_wait(kKeep), "");
  EXPECT_EQ(turns_after(left, kKeep, Turn::kKept), 30);
  EXPECT_EQ(left.why_to_wait(kKeep), "");
  EXPECT_EQ(turns_after(left, kKeep, Turn::kNone), 0) << "it is told once";
  Requester on = switched_on();
  EXPECT_EQ(turns_after(on, kKeep, Turn::kEnds), 30);
  EXPECT_TRUE(on.why_ended(kKeep).ends_with(
      "; it was to be kept, and the bridge was restarted as well: ask again"));
}

TEST(Requester, AGoalGoesOnWhenItIsHeard) {
  for (Requester requester : {cut_off(), recalled(), switched_on()}) {
    requester.hear();
    for (const v1::WriterLost policy : {kEndsWithIt, kKeep}) {
      EXPECT_EQ(requester.why_to_wait(policy), "");
      EXPECT_EQ(turns_after(requester, policy, Turn::kNone), 0);
    }
  }
}

TEST(Requester, IsToldOfAfterThreeSecondsAtMost) {
  EXPECT_FALSE(cut_off().is_meeting(kBegin));
  EXPECT_TRUE(recalled().is_meeting(kBegin + 29));
  EXPECT_TRUE(switched_on().is_meeting(kBegin + 29));
  EXPECT_FALSE(recalled().is_meeting(kBegin + 30));
}

TEST(Requester, ASecondCauseDoesNotProlongTheFirst) {
  Requester requester = cut_off();
  requester.cut_off(kBegin + 50);
  requester.meet_bridge();
  EXPECT_EQ(requester, cut_off());
  requester = recalled();
  requester.cut_off(kBegin + 50);
  EXPECT_EQ(requester, recalled());
}

}  // namespace
}  // namespace saphira::intentions
