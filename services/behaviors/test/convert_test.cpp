#include "behaviors/shell/convert.hpp"

#include <gtest/gtest.h>

namespace saphira::behaviors {
namespace {

v1::Pose2 pose(double x, double y, double th) {
  return {.x = x, .y = y, .th = th};
}

TEST(Convert, Description) {
  v1::RobotDescription description{.radius = 0.3,
                                   .max_velocity = 0.5,
                                   .max_rotation_velocity = 2.0,
                                   .deceleration = 1.5,
                                   .front_buffer = 31,
                                   .side_buffer = 41,
                                   .front_max_range = 2.25};
  v1::SonarPose sonar{.sonar = 4, .pose_in_robot = pose(0.1, -0.2, 0.3)};
  description.sonars.push_back(sonar);
  const RobotModel model = from_bus(description);
  EXPECT_EQ(model.radius, 0.3);
  EXPECT_EQ(model.max_velocity, 0.5);
  EXPECT_EQ(model.max_rotation_velocity, 2.0);
  EXPECT_EQ(model.deceleration, 1.5);
  EXPECT_EQ(model.lps.front_buffer, 31U);
  EXPECT_EQ(model.lps.side_buffer, 41U);
  EXPECT_EQ(model.lps.front_max_range, 2.25);
  ASSERT_EQ(model.lps.sonars.size(), 1U);
  EXPECT_EQ(model.lps.sonars[0].sonar, 4);
  EXPECT_EQ(model.lps.sonars[0].in_robot, (Pose{0.1, -0.2, 0.3}));
}

TEST(Convert, State) {
  v1::RobotState state{.pose_in_odom = pose(1, 2, 3), .velocity = 0.25, .rotation_velocity = -0.5};
  const RobotNow now = from_bus(state);
  EXPECT_EQ(now.pose_in_odom, (Pose{1, 2, 3}));
  EXPECT_EQ(now.velocity, 0.25);
  EXPECT_EQ(now.rotation_velocity, -0.5);
}

TEST(Convert, Intentions) {
  v1::Intentions sample{.stamp = {3, 7}, .behavior_control = true};
  v1::IntendedBehavior behavior{.name = "go", .schema = "GoToPos", .priority = 2, .running = false};
  v1::Argument argument{.name = "speed", .kind = v1::ARGUMENT_NUMBER, .number = 0.3};
  behavior.parameters.push_back(argument);
  argument.name = "preferred_turn";
  argument.kind = v1::ARGUMENT_TEXT;
  argument.text = "left";
  behavior.parameters.push_back(argument);
  argument.name = "goal";
  argument.kind = v1::ARGUMENT_POINT;
  argument.point = pose(1, 2, 3);
  for (const v1::Frame frame : {v1::FRAME_ROBOT, v1::FRAME_ODOM, v1::FRAME_MAP}) {
    argument.frame = frame;
    behavior.parameters.push_back(argument);
  }
  sample.behaviors.push_back(behavior);
  const Intent intent = from_bus(sample);
  EXPECT_EQ(intent.cycle, 7U);
  EXPECT_TRUE(intent.control);
  ASSERT_EQ(intent.behaviors.size(), 1U);
  const Intended& wanted = intent.behaviors[0];
  EXPECT_EQ(wanted.name, "go");
  EXPECT_EQ(wanted.schema, "GoToPos");
  EXPECT_EQ(wanted.priority, 2);
  EXPECT_FALSE(wanted.running);
  const std::vector<Argument> expected{{"speed", 0.3},
                                       {"preferred_turn", "left"},
                                       {"goal", PlacedPoint{{1, 2, 3}, Frame::robot}},
                                       {"goal", PlacedPoint{{1, 2, 3}, Frame::odom}},
                                       {"goal", PlacedPoint{{1, 2, 3}, Frame::map}}};
  EXPECT_EQ(wanted.parameters, expected);
}

TEST(Convert, Output) {
  Output output;
  output.control = true;
  output.trouble = "something";
  output.blend = {true, 0.25, true, 0.125};
  output.active = true;
  output.speed = 0.125;
  output.heading_in_odom = -3.0;
  BehaviorState state;
  state.name = "go";
  state.schema = "GoToPos";
  state.running = true;
  state.blended.priority = 2;
  state.blended.turn_weight = 0.1;
  state.blended.speed_weight = 0.2;
  state.blended.recommends_turn = true;
  state.blended.turn = 0.3;
  state.blended.recommends_speed = true;
  state.blended.speed = 0.4;
  state.blended.evaluation.activity = {0.5, 0.6, 0.7, 0.8};
  const Action actions[] = {Action::turn_left, Action::turn_right, Action::accelerate,
                            Action::decelerate, Action::speed};
  for (const Action action : actions)
    state.blended.evaluation.rules.push_back({"rule", 0.9, action, 1.1});
  state.blended.evaluation.variables = {{"too_left", 0.25}};
  output.behaviors.push_back(state);

  const v1::BehaviorSet sample = to_bus(output);
  EXPECT_TRUE(sample.control);
  EXPECT_EQ(sample.trouble, "something");
  EXPECT_TRUE(sample.turning);
  EXPECT_EQ(sample.turn, 0.25);
  EXPECT_TRUE(sample.moving);
  EXPECT_EQ(sample.speed, 0.125);
  ASSERT_EQ(sample.behaviors.size(), 1U);
  const v1::BehaviorState& b = sample.behaviors[0];
  EXPECT_EQ(b.name, "go");
  EXPECT_EQ(b.schema, "GoToPos");
  EXPECT_TRUE(b.running);
  EXPECT_EQ(b.priority, 2);
  EXPECT_EQ(b.turn_weight, 0.1);
  EXPECT_EQ(b.speed_weight, 0.2);
  EXPECT_TRUE(b.recommends_turn);
  EXPECT_EQ(b.turn, 0.3);
  EXPECT_TRUE(b.recommends_speed);
  EXPECT_EQ(b.speed, 0.4);
  EXPECT_EQ(b.turn_activity, 0.5);
  EXPECT_EQ(b.speed_activity, 0.6);
  EXPECT_EQ(b.goal, 0.7);
  EXPECT_EQ(b.progress, 0.8);
  ASSERT_EQ(b.rules.size(), 5U);
  EXPECT_EQ(b.rules[0].name, "rule");
  EXPECT_EQ(b.rules[0].strength, 0.9);
  EXPECT_EQ(b.rules[0].value, 1.1);
  const v1::ControlAction expected[] = {v1::CONTROL_TURN_LEFT, v1::CONTROL_TURN_RIGHT,
                                        v1::CONTROL_ACCELERATE, v1::CONTROL_DECELERATE,
                                        v1::CONTROL_SPEED};
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_EQ(b.rules[i].action, expected[i]);

  ASSERT_EQ(b.variables.size(), 1U);
  EXPECT_EQ(b.variables[0].name, "too_left");
  EXPECT_EQ(b.variables[0].value, 0.25);

  v1::MotorCommand command = command_to_bus(output);
  EXPECT_TRUE(command.active);
  EXPECT_EQ(command.translation, v1::TRANSLATION_VELOCITY);
  EXPECT_EQ(command.velocity, 0.125);
  EXPECT_EQ(command.rotation, v1::ROTATION_HEADING);
  EXPECT_EQ(command.heading, -3.0);
  output.active = false;
  command = command_to_bus(output);
  EXPECT_FALSE(command.active);
  EXPECT_EQ(command.translation, v1::TRANSLATION_NONE);
  EXPECT_EQ(command.rotation, v1::ROTATION_NONE);
}

TEST(Convert, Schemas) {
  Schema schema;
  schema.name = "Test";
  schema.summary = "does it";
  schema.source = "test.beh";
  schema.parameters = {number_parameter("speed", "m/s", 0.5, 2.0, 1.0),
                       point_parameter("goal", "where to"),
                       choice_parameter("side", "which", {"left", "right"})};
  schema.rules = {{"r", "a And Not b", "Turn Left Slowly"}};
  Registry registry;
  registry.add(schema);
  const v1::BehaviorSchemas sample = to_bus(registry, "bad.beh:1:1: wrong");
  EXPECT_EQ(sample.trouble, "bad.beh:1:1: wrong");
  ASSERT_EQ(sample.schemas.size(), 1U);
  const v1::BehaviorSchema& s = sample.schemas[0];
  EXPECT_EQ(s.name, "Test");
  EXPECT_EQ(s.summary, "does it");
  EXPECT_EQ(s.source, "test.beh");
  ASSERT_EQ(s.parameters.size(), 3U);
  EXPECT_EQ(s.parameters[0].kind, v1::ARGUMENT_NUMBER);
  EXPECT_EQ(s.parameters[0].low, 0.5);
  EXPECT_EQ(s.parameters[0].high, 2.0);
  EXPECT_EQ(s.parameters[0].usual, 1.0);
  EXPECT_EQ(s.parameters[1].kind, v1::ARGUMENT_POINT);
  EXPECT_TRUE(s.parameters[1].required);
  EXPECT_EQ(s.parameters[2].kind, v1::ARGUMENT_TEXT);
  EXPECT_EQ(s.parameters[2].choices, (std::vector<std::string>{"left", "right"}));
  ASSERT_EQ(s.rules.size(), 1U);
  EXPECT_EQ(s.rules[0].antecedent, "a And Not b");
  EXPECT_EQ(s.rules[0].action, "Turn Left Slowly");
}

TEST(Convert, NoMoreRulesThanTheContractHas) {
  BehaviorState state;
  state.blended.evaluation.rules.resize(100);
  EXPECT_EQ(to_bus(state).rules.size(), 64U);
}

}  // namespace
}  // namespace saphira::behaviors
