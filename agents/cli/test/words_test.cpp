#include "saphira/cli/words.hpp"

#include <gtest/gtest.h>

namespace saphira::cli {
namespace {

SeenProcess process(const std::string& name, double age) {
  SeenProcess seen;
  seen.status.name(name);
  seen.status.state(v1::SERVICE_RUNNING);
  seen.status.late_cycles(7);
  seen.status.pid(42);
  seen.age = age;
  return seen;
}

TEST(Table, AlignsColumns) {
  EXPECT_EQ(table({{"NAME", "N", "WHY"}, {"a", "100", "x"}, {"long name", "7", ""}}),
            "NAME       N    WHY\n"
            "a          100  x\n"
            "long name    7\n");
}

TEST(StatusTable, SaysWhoIsLost) {
  const std::string text = status_table({process("intentions", 0.5), process("behaviors", 3.5)});
  const std::size_t behaviors = text.find("behaviors");
  const std::size_t intentions = text.find("intentions");
  ASSERT_NE(behaviors, std::string::npos);
  ASSERT_NE(intentions, std::string::npos);
  EXPECT_LT(behaviors, intentions);
  EXPECT_LT(behaviors, text.find("lost"));
  EXPECT_LT(text.find("lost"), intentions);
  EXPECT_EQ(text.find("lost", intentions), std::string::npos);
  EXPECT_NE(text.find("running", intentions), std::string::npos);
}

TEST(MissingServices, AreNamed) {
  EXPECT_EQ(missing_services({}), "bridge, behaviors and intentions");
  EXPECT_EQ(missing_services({process("bridge", 0.1), process("intentions", 9.0)}),
            "behaviors and intentions");
  EXPECT_EQ(missing_services(
                {process("bridge", 0.1), process("intentions", 0.1), process("behaviors", 0.1)}),
            "");
}

TEST(DescribeGrant, SaysWhatIsLatchedAndHowItIsReleased) {
  v1::Grant grant;
  EXPECT_EQ(latched(grant), "");
  grant.reason("keyboard (teleop) does not want to drive");
  grant.waits_for_hand_back(true);
  EXPECT_EQ(describe(grant),
            "nobody drives: keyboard (teleop) does not want to drive; autonomy waits until the "
            "robot is handed back: saphira drive hand-back");
  grant.role(v1::ROLE_ESTOP);
  grant.estopped(true);
  grant.estop_source("panel");
  EXPECT_EQ(describe(grant),
            "EMERGENCY STOP, pressed by panel: the robot stands until saphira estop reset");
}

TEST(DescribeGrant, SaysWhoWhyAndWhatTheGuardDoes) {
  v1::Grant grant;
  grant.role(v1::ROLE_NONE);
  grant.reason("no command yet");
  EXPECT_EQ(describe(grant), "nobody drives: no command yet");
  grant.role(v1::ROLE_TELEOP);
  grant.source("keyboard");
  grant.reason("strongest");
  grant.guard(v1::GUARD_SLOW);
  grant.guard_reason("0.3 m ahead");
  v1::Refusal refusal;
  refusal.role(v1::ROLE_DIRECT);
  refusal.source("agent");
  refusal.reason("repeated number");
  grant.refused({refusal});
  EXPECT_EQ(describe(grant),
            "teleop drives (keyboard): strongest; the guard slows: 0.3 m ahead; refused agent "
            "(direct): repeated number");
}

}  // namespace
}  // namespace saphira::cli
