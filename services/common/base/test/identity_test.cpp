#include "saphira/base/identity.hpp"

#include <gtest/gtest.h>

namespace saphira {
namespace {

const Identity kOperator{"karen", "operator"};
const Identity kAgent{"planner", "agent"};

TEST(Identity, OwnersAndOperatorsEndWhatIsAskedFor) {
  const Identity observer{"john", "observer"};
  EXPECT_TRUE(may_end(kAgent, kAgent));
  EXPECT_TRUE(may_end(kOperator, kAgent));
  EXPECT_FALSE(may_end(kAgent, kOperator));
  EXPECT_FALSE(may_end(observer, kAgent));
  EXPECT_TRUE(may_end(std::nullopt, kOperator));
  EXPECT_TRUE(may_end(kAgent, std::nullopt));
}

TEST(Identity, TwoUnknownAreNotOnePerson) {
  const Identity stranger{"", "agent"};
  EXPECT_FALSE(may_end(stranger, stranger));
}

TEST(Identity, AWriterThatNamesNobodyActsForItself) {
  EXPECT_EQ(acting_for(kAgent, {"", "operator"}), kAgent);
  EXPECT_EQ(acting_for(std::nullopt, {}), std::nullopt);
}

TEST(Identity, TheRobotsServicesPassOnWhomTheyHaveChecked) {
  EXPECT_EQ(acting_for(Identity{"flakey", "services"}, kOperator), kOperator);
  EXPECT_EQ(acting_for(Identity{"flakey", "robot"}, kAgent), kAgent);
  EXPECT_EQ(acting_for(std::nullopt, kAgent), kAgent);
}

TEST(Identity, APersonAtADoorIsNoMemberAndHasItsRightsAtMost) {
  const Identity anna{"anna", "operator"};
  EXPECT_EQ(acting_for(kOperator, anna), (Identity{"anna at karen", "operator"}));
  EXPECT_EQ(acting_for(kAgent, anna), (Identity{"anna at planner", "agent"}));
  EXPECT_EQ(acting_for(kOperator, {"anna", "agent"}), (Identity{"anna at karen", "agent"}));
  EXPECT_EQ(acting_for(kOperator, {"anna", "services"}), (Identity{"anna at karen", "observer"}));
  EXPECT_FALSE(may_end(acting_for(kAgent, kOperator), kOperator));
  EXPECT_TRUE(may_end(kAgent, acting_for(kAgent, anna))) << "the door";
  EXPECT_FALSE(may_end(acting_for(kAgent, kOperator), acting_for(kAgent, anna)));
}

TEST(Identity, NobodyElseSpeaksForPersons) {
  const Identity observer{"john", "observer"};
  EXPECT_EQ(acting_for(observer, kOperator), observer);
  const Identity stranger{"", "agent"};
  EXPECT_EQ(acting_for(stranger, kOperator), stranger);
}

TEST(Identity, AStatusOfAnotherRoleIsOfNoNamesake) {
  const Identity services{"flakey", "services"};
  const Identity bridge{"flakey", "bridge"};
  const Identity robot{"flakey", "robot"};
  const Identity recorder{"box", "recorder"};
  EXPECT_TRUE(may_be_of_a_kind(services, &services));
  EXPECT_TRUE(may_be_of_a_kind(services, &robot));
  EXPECT_TRUE(may_be_of_a_kind(robot, &bridge));
  EXPECT_TRUE(may_be_of_a_kind(kAgent, &kAgent));
  EXPECT_TRUE(may_be_of_a_kind(std::nullopt, nullptr)) << "an open bus";
  for (const Identity* other : {&recorder, &kOperator, &bridge})
    EXPECT_FALSE(may_be_of_a_kind(services, other)) << other->role;
  EXPECT_FALSE(may_be_of_a_kind(robot, &recorder));
}

TEST(Identity, StandsBeforeWhatSomebodyCallsItself) {
  EXPECT_EQ(named("saphira goal", kOperator), "karen (operator), saphira goal");
  EXPECT_EQ(named("", kOperator), "karen (operator)");
  EXPECT_EQ(named("saphira goal", std::nullopt), "saphira goal");
  // Passed on by a program between.
  EXPECT_EQ(named("karen (operator), saphira ask", kOperator), "karen (operator), saphira ask");
  EXPECT_EQ(named("karen (operator), saphira ask", kAgent),
            "planner (agent), karen (operator), saphira ask");
  EXPECT_TRUE(is_named("planner (agent), sweeper", "sweeper"));
  EXPECT_TRUE(is_named("sweeper", "sweeper"));
  EXPECT_FALSE(is_named("planner (agent), sweeper 2", "sweeper"));
  EXPECT_FALSE(is_named("a sweeper", "sweeper"));
  EXPECT_FALSE(is_named("planner (agent)", ""));
}

}  // namespace
}  // namespace saphira
