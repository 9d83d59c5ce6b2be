#include "intentions/shell/convert.hpp"

#include <gtest/gtest.h>

#include <tuple>

#include "requests/shell/convert.hpp"

namespace saphira::intentions {
namespace {

Arguments all_kinds() {
  return {number("speed", 0.25), text("name", "über \"x\""), point("position", {1.0, -2.0, 0.5}),
          point("other", {1e-17, 1e9, -3.0}, Frame::robot),
          point("third", {0.1, 0.2, 0.3}, Frame::map)};
}

TEST(Convert, AGoalIsTakenWhole) {
  v1::Goal theirs{.id = {0xffffffffffffffffULL, 3},
                  .requester = "somebody",
                  .functor = "go_to",
                  .arguments = saphira::to_bus(all_kinds()),
                  .priority = -7,
                  .deadline = 12.5,
                  .writer_lost = v1::WRITER_LOST_KEEP,
                  .level = 0.25};
  EXPECT_EQ(from_bus(theirs), (Goal{{0xffffffffffffffffULL, 3},
                                    "somebody",
                                    "go_to",
                                    all_kinds(),
                                    -7,
                                    12.5,
                                    v1::WRITER_LOST_KEEP,
                                    0.25}));
}

TEST(Convert, WhatDoesNotKeepToTheContractIsRefusedLater) {
  v1::Argument argument{.kind = static_cast<v1::ArgumentKind>(77),
                        .frame = static_cast<v1::Frame>(77)};
  EXPECT_EQ(saphira::from_bus(argument).kind, ArgumentKind::unbound);
}

TEST(Convert, AGrantSaysWhyTheBehaviorsDoNotDriveAndWhichPersonDoes) {
  v1::Grant grant;
  grant.refused.resize(2);
  grant.refused[0].role = v1::ROLE_DIRECT;
  grant.refused[0].reason = "of another";
  grant.refused[1].role = v1::ROLE_BEHAVIORS;
  grant.refused[1].reason = "a person drives";
  grant.role = v1::ROLE_TELEOP;
  grant.waits_for_hand_back = true;
  Core::Heard::Grant heard = from_bus(grant);
  EXPECT_FALSE(heard.pressed);
  EXPECT_EQ(heard.refusal, "a person drives");
  EXPECT_EQ(heard.person, "a person");
  EXPECT_TRUE(heard.waits_for_hand_back);
  grant.source = "Ann";
  EXPECT_EQ(from_bus(grant).person, "Ann");
  grant.role = v1::ROLE_BEHAVIORS;
  grant.estopped = true;
  grant.estop_source = "a button";
  heard = from_bus(grant);
  EXPECT_TRUE(heard.pressed);
  EXPECT_EQ(heard.source, "a button");
  EXPECT_EQ(heard.refusal, "");
  EXPECT_EQ(heard.person, "");
}

TEST(Convert, WhichMotorsHavePowerAndWhichRobotIsConnected) {
  for (const auto& [status, connected, power] :
       {std::tuple(v1::MOTORS_MOVING, true, true), std::tuple(v1::MOTORS_NO_POWER, true, false),
        std::tuple(v1::MOTORS_NOT_CONNECTED, false, true)}) {
    const Robot robot = from_bus(v1::RobotState{.status = status});
    EXPECT_EQ(robot.connected, connected) << status;
    EXPECT_EQ(robot.has_power, power) << status;
  }
}

TEST(Convert, ThePlaceOnTheMapOnlyWhereRegistrationKnowsIt) {
  v1::Registration registration{.stamp = {.cycle = 100},
                                .state = v1::REGISTRATION_TRACKING,
                                .odom = 4,
                                .odom_in_map = {.x = 2.0, .th = 0.5}};
  EXPECT_EQ(odom_in_map_from_bus(registration, 101, 4), (Pose{2.0, 0.0, 0.5}));
  EXPECT_TRUE(odom_in_map_from_bus(registration, 100 + kRegistrationLease, 4));
  EXPECT_FALSE(odom_in_map_from_bus(registration, 101 + kRegistrationLease, 4));
  EXPECT_FALSE(odom_in_map_from_bus(registration, 101, 5));
  registration.state = v1::REGISTRATION_LOST;
  EXPECT_FALSE(odom_in_map_from_bus(registration, 101, 4));
  registration.state = v1::REGISTRATION_UNPLACED;
  EXPECT_FALSE(odom_in_map_from_bus(registration, 101, 4));
  registration.state = v1::REGISTRATION_OFF;
  EXPECT_TRUE(odom_in_map_from_bus(registration, 101, 4));
}

TEST(Convert, WhatInterpretationSawCountsForAWhile) {
  v1::Perception perception{.stamp = {.cycle = 100}, .odom = 4};
  perception.percepts.emplace_back();
  EXPECT_EQ(percepts_from_bus(perception, 100 + kRegistrationLease, 4).value().size(), 1U);
  EXPECT_FALSE(percepts_from_bus(perception, 101 + kRegistrationLease, 4));
  EXPECT_TRUE(percepts_from_bus(perception, 101, 5).value().empty()) << "of another odom frame";
}

}  // namespace
}  // namespace saphira::intentions
