#include "intentions/shell/convert.hpp"

#include <gtest/gtest.h>

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

TEST(Convert, ABehaviorAndItsIntentionAreToldWhole) {
  const IntendedBehavior behavior{"GoToPos#3", "GoToPos", 2, false, all_kinds(), 3, false};
  const v1::IntendedBehavior intended = to_bus(behavior);
  EXPECT_EQ(intended.name, "GoToPos#3");
  EXPECT_EQ(intended.schema, "GoToPos");
  EXPECT_EQ(intended.priority, 2);
  EXPECT_FALSE(intended.running);
  EXPECT_EQ(saphira::from_bus(intended.parameters), all_kinds());
  EXPECT_EQ(intended.intention, 3U);
  EXPECT_FALSE(intended.blocking);

  IntentionNode node;
  node.id = 3;
  node.parent = 2;
  node.name = "GoToPos#3";
  node.schema = "GoToPos";
  node.blocking = false;
  node.step = "B";
  node.state = IntentionState::kResumed;
  node.goal = {1, 2};
  const v1::IntentionNode told = to_bus(node);
  EXPECT_EQ(told.id, 3U);
  EXPECT_EQ(told.parent, 2U);
  EXPECT_EQ(told.name, "GoToPos#3");
  EXPECT_EQ(told.schema, "GoToPos");
  EXPECT_FALSE(told.blocking);
  EXPECT_EQ(told.step, "B");
  EXPECT_EQ(told.state, v1::INTENTION_RUNNING);
  EXPECT_EQ(told.goal, node.goal);
}

TEST(Convert, WhatDoesNotKeepToTheContractIsRefusedLater) {
  v1::Argument argument{.kind = static_cast<v1::ArgumentKind>(77),
                        .frame = static_cast<v1::Frame>(77)};
  EXPECT_EQ(saphira::from_bus(argument).kind, ArgumentKind::unbound);
  v1::Goal goal{.writer_lost = static_cast<v1::WriterLost>(77)};
  EXPECT_EQ(from_bus(goal).writer_lost, v1::WRITER_LOST_CANCEL);
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

TEST(Convert, TakesWhatItNeedsOfTheRobotAndTheBehaviors) {
  v1::RobotState state{.odom = 4,
                       .pose_in_odom = {1.0, 2.0, 3.0},
                       .velocity = 0.4,
                       .rotation_velocity = -0.5,
                       .target_velocity = 0.3,
                       .target_heading_in_odom = 1.5,
                       .status = v1::MOTORS_MOVING};
  Robot robot = from_bus(state);
  EXPECT_TRUE(robot.connected);
  EXPECT_TRUE(robot.has_power);
  EXPECT_EQ(robot.odom, 4U);
  EXPECT_EQ(robot.pose_in_odom, (Pose{1.0, 2.0, 3.0}));
  EXPECT_EQ(robot.velocity, 0.4);
  EXPECT_EQ(robot.rotation_velocity, -0.5);
  EXPECT_EQ(robot.target_velocity, 0.3);
  EXPECT_EQ(robot.target_heading_in_odom, 1.5);
  state.status = v1::MOTORS_NO_POWER;
  EXPECT_FALSE(from_bus(state).has_power);
  state.status = v1::MOTORS_NOT_CONNECTED;
  EXPECT_FALSE(from_bus(state).connected);

  v1::BehaviorSet behaviors;
  behaviors.behaviors.push_back({.name = "GoToPos#3", .goal = 0.7, .progress = 0.2});
  behaviors.missing.push_back({.name = "Fly#4", .reason = "unknown schema"});
  const std::vector<BehaviorTrouble> troubles = troubles_from_bus(behaviors);
  ASSERT_EQ(troubles.size(), 1U);
  EXPECT_EQ(troubles[0].name, "Fly#4");
  EXPECT_EQ(troubles[0].reason, "unknown schema");
  const std::vector<BehaviorLevel> levels = from_bus(behaviors);
  ASSERT_EQ(levels.size(), 1U);
  EXPECT_EQ(levels[0].name, "GoToPos#3");
  EXPECT_EQ(levels[0].goal, 0.7);
  EXPECT_EQ(levels[0].progress, 0.2);
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
