#include "behaviors/shell/convert.hpp"

#include <gtest/gtest.h>

namespace saphira::behaviors {
namespace {

TEST(Convert, EachActionIsTheContracts) {
  BehaviorState state;
  const Action actions[] = {Action::turn_left, Action::turn_right, Action::accelerate,
                            Action::decelerate, Action::speed};
  for (const Action action : actions)
    state.blended.evaluation.rules.push_back({"rule", 0.9, action, 1.1});
  const v1::BehaviorState sample = to_bus(state);
  ASSERT_EQ(sample.rules.size(), 5U);
  const v1::ControlAction expected[] = {v1::CONTROL_TURN_LEFT, v1::CONTROL_TURN_RIGHT,
                                        v1::CONTROL_ACCELERATE, v1::CONTROL_DECELERATE,
                                        v1::CONTROL_SPEED};
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_EQ(sample.rules[i].action, expected[i]);
}

TEST(Convert, BehaviorsThatDoNotDriveCommandNothing) {
  Output output;
  output.speed = 0.125;
  output.heading_in_odom = -3.0;
  EXPECT_EQ(command_to_bus(output), v1::MotorCommand());
  output.active = true;
  EXPECT_EQ(command_to_bus(output), (v1::MotorCommand{.active = true,
                                                      .translation = v1::TRANSLATION_VELOCITY,
                                                      .velocity = 0.125,
                                                      .rotation = v1::ROTATION_HEADING,
                                                      .heading = -3.0}));
}

TEST(Convert, NoMoreRulesThanTheContractHas) {
  BehaviorState state;
  state.blended.evaluation.rules.resize(100);
  EXPECT_EQ(to_bus(state).rules.size(), 64U);
}

}  // namespace
}  // namespace saphira::behaviors
