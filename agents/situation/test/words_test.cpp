#include "saphira/situation/words.hpp"

#include <gtest/gtest.h>

namespace saphira::situation {
namespace {

TEST(DescribeGrant, SaysWhatIsLatchedAndHowItIsReleased) {
  v1::Grant grant;
  EXPECT_EQ(latched(grant), "");
  grant.reason = "keyboard (teleop) does not want to drive";
  grant.waits_for_hand_back = true;
  EXPECT_EQ(describe(grant),
            "nobody drives: keyboard (teleop) does not want to drive; autonomy waits until the "
            "robot is handed back: saphira drive hand-back");
  grant.role = v1::ROLE_ESTOP;
  grant.estopped = true;
  grant.estop_source = "panel";
  EXPECT_EQ(describe(grant),
            "EMERGENCY STOP, pressed by panel: the robot stands until saphira estop reset");
}

TEST(DescribeGrant, SaysWhoWhyAndWhatTheGuardDoes) {
  v1::Grant grant{.role = v1::ROLE_NONE, .reason = "no command yet"};
  EXPECT_EQ(describe(grant), "nobody drives: no command yet");
  grant.role = v1::ROLE_TELEOP;
  grant.source = "keyboard";
  grant.reason = "strongest";
  grant.guard = v1::GUARD_SLOW;
  grant.guard_reason = "0.3 m ahead";
  v1::Refusal refusal{.role = v1::ROLE_DIRECT, .source = "agent", .reason = "repeated number"};
  grant.refused = {refusal};
  EXPECT_EQ(describe(grant),
            "teleop drives (keyboard): strongest; the guard slows: 0.3 m ahead; refused agent "
            "(direct): repeated number");
}

}  // namespace
}  // namespace saphira::situation
