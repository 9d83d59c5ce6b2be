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

TEST(Convert, GoalsRoundTrip) {
  Goal goal;
  goal.id = {0xffffffffffffffffULL, 3};
  goal.requester = "somebody";
  goal.functor = "go_to";
  goal.arguments = all_kinds();
  goal.priority = -7;
  goal.deadline = 12.5;
  for (const WriterLost policy : {WriterLost::kCancel, WriterLost::kKeep}) {
    goal.writer_lost = policy;
    EXPECT_EQ(from_bus(to_bus(goal)), goal);
  }
}

TEST(Convert, GoalStatusesRoundTrip) {
  GoalStatus status;
  status.id = {1, 2};
  status.requester = "somebody";
  status.functor = "drive";
  status.reason = "why";
  status.step = "driving";
  status.progress = 0.3;
  status.elapsed = 4.1;
  status.waits_for = {0xfffffffffffffffeULL, 7};
  v1::Stamp stamp;
  stamp.epoch(5);
  stamp.cycle(6);
  for (const GoalState state :
       {GoalState::kWaiting, GoalState::kRefused, GoalState::kUnderway, GoalState::kSuspended,
        GoalState::kSucceeded, GoalState::kFailed, GoalState::kCanceled}) {
    status.state = state;
    EXPECT_EQ(from_bus(to_bus(status, stamp)), status);
  }
  for (const GoalCode code :
       {GoalCode::kNone, GoalCode::kUnknownFunctor, GoalCode::kBadArgument, GoalCode::kChanged,
        GoalCode::kTooMany, GoalCode::kForgotten, GoalCode::kDeadline, GoalCode::kBlocked,
        GoalCode::kNoRobot, GoalCode::kDisposed, GoalCode::kWriterLost, GoalCode::kPreempted}) {
    status.code = code;
    EXPECT_EQ(from_bus(to_bus(status, stamp)), status);
  }
  EXPECT_EQ(to_bus(status, stamp).code(), v1::CODE_PREEMPTED);
  EXPECT_EQ(to_bus(status, stamp).stamp(), stamp);
}

TEST(Convert, IntendedBehaviorsRoundTrip) {
  IntendedBehavior behavior;
  behavior.name = "GoToPos#3";
  behavior.schema = "GoToPos";
  behavior.priority = 2;
  behavior.running = false;
  behavior.parameters = all_kinds();
  behavior.intention = 3;
  EXPECT_EQ(from_bus(to_bus(behavior)), behavior);
}

TEST(Convert, IntentionNodesRoundTrip) {
  IntentionNode node;
  node.id = 3;
  node.parent = 2;
  node.name = "GoToPos#3";
  node.schema = "GoToPos";
  node.blocking = false;
  node.step = "B";
  node.goal = {1, 2};
  for (const IntentionState state :
       {IntentionState::kInit, IntentionState::kRunning, IntentionState::kSuspended,
        IntentionState::kInterrupted, IntentionState::kSuccess, IntentionState::kFailure,
        IntentionState::kTimeout}) {
    node.state = state;
    EXPECT_EQ(from_bus(to_bus(node)), node);
  }
  node.state = IntentionState::kResumed;
  EXPECT_EQ(to_bus(node).state(), v1::INTENTION_RUNNING);
}

TEST(Convert, WhatDoesNotKeepToTheContractIsRefusedLater) {
  v1::Argument argument;
  argument.kind(static_cast<v1::ArgumentKind>(77));
  argument.frame(static_cast<v1::Frame>(77));
  EXPECT_EQ(saphira::from_bus(argument).kind, ArgumentKind::unbound);
  v1::Goal goal;
  goal.writer_lost(static_cast<v1::WriterLost>(77));
  EXPECT_EQ(from_bus(goal).writer_lost, WriterLost::kCancel);
}

TEST(Convert, TakesWhatItNeedsOfTheRobotAndTheBehaviors) {
  v1::RobotState state;
  state.odom(4);
  state.pose_in_odom().x(1.0);
  state.pose_in_odom().y(2.0);
  state.pose_in_odom().th(3.0);
  state.velocity(0.4);
  state.rotation_velocity(-0.5);
  state.target_velocity(0.3);
  state.target_heading_in_odom(1.5);
  state.status(v1::MOTORS_MOVING);
  Robot robot = from_bus(state);
  EXPECT_TRUE(robot.connected);
  EXPECT_TRUE(robot.has_power);
  EXPECT_EQ(robot.odom, 4U);
  EXPECT_EQ(robot.pose_in_odom, (Pose{1.0, 2.0, 3.0}));
  EXPECT_EQ(robot.velocity, 0.4);
  EXPECT_EQ(robot.rotation_velocity, -0.5);
  EXPECT_EQ(robot.target_velocity, 0.3);
  EXPECT_EQ(robot.target_heading_in_odom, 1.5);
  state.status(v1::MOTORS_NO_POWER);
  EXPECT_FALSE(from_bus(state).has_power);
  state.status(v1::MOTORS_NOT_CONNECTED);
  EXPECT_FALSE(from_bus(state).connected);

  v1::BehaviorSet behaviors;
  v1::BehaviorState behavior;
  behavior.name("GoToPos#3");
  behavior.goal(0.7);
  behavior.progress(0.2);
  behaviors.behaviors().push_back(behavior);
  const std::vector<BehaviorLevel> levels = from_bus(behaviors);
  ASSERT_EQ(levels.size(), 1U);
  EXPECT_EQ(levels[0].name, "GoToPos#3");
  EXPECT_EQ(levels[0].goal, 0.7);
  EXPECT_EQ(levels[0].progress, 0.2);
}

TEST(Convert, ThePlaceOnTheMapOnlyWhereRegistrationKnowsIt) {
  v1::Registration registration;
  registration.state(v1::REGISTRATION_TRACKING);
  registration.odom(4);
  registration.stamp().cycle(100);
  registration.odom_in_map().x(2.0);
  registration.odom_in_map().th(0.5);
  EXPECT_EQ(odom_in_map_from_bus(registration, 101, 4), (Pose{2.0, 0.0, 0.5}));
  EXPECT_TRUE(odom_in_map_from_bus(registration, 100 + kRegistrationLease, 4));
  EXPECT_FALSE(odom_in_map_from_bus(registration, 101 + kRegistrationLease, 4));
  EXPECT_FALSE(odom_in_map_from_bus(registration, 101, 5));
  registration.state(v1::REGISTRATION_LOST);
  EXPECT_FALSE(odom_in_map_from_bus(registration, 101, 4));
  registration.state(v1::REGISTRATION_UNPLACED);
  EXPECT_FALSE(odom_in_map_from_bus(registration, 101, 4));
  registration.state(v1::REGISTRATION_OFF);
  EXPECT_TRUE(odom_in_map_from_bus(registration, 101, 4));
}

TEST(Convert, WhatInterpretationSawCountsForAWhile) {
  v1::Perception perception;
  perception.stamp().cycle(100);
  perception.odom(4);
  perception.percepts().emplace_back();
  EXPECT_EQ(percepts_from_bus(perception, 100 + kRegistrationLease, 4).value().size(), 1U);
  EXPECT_FALSE(percepts_from_bus(perception, 101 + kRegistrationLease, 4));
  EXPECT_TRUE(percepts_from_bus(perception, 101, 5).value().empty()) << "of another odom frame";
}

}  // namespace
}  // namespace saphira::intentions
