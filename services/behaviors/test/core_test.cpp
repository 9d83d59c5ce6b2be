#include "saphira/behaviors/core.hpp"

#include <gtest/gtest.h>

#include "pioneer.hpp"

namespace saphira::behaviors {
namespace {

class CoreTest : public testing::Test {
 protected:
  /// A step with ConstantVelocity intended in the cycle before.
  Core::Outputs step() {
    inputs_.intent = Intent{inputs_.cycle, true, {{"v", "ConstantVelocity", 2, true, {}}}};
    return step_with_that_intent();
  }
  Core::Outputs step_with_that_intent() {
    ++inputs_.cycle;
    inputs_.new_robot = inputs_.cycle == 1 ? &robot_ : nullptr;
    inputs_.schemas = inputs_.cycle == 1 ? &schemas_ : nullptr;
    core_.processes().step(inputs_.cycle);
    Core::Outputs outputs = core_.step(inputs_);
    inputs_.new_frame = false;
    return outputs;
  }

  const RobotModel robot_ = pioneer();
  const Registry schemas_ = predefined();
  Core core_;
  Core::Inputs inputs_;
};

TEST_F(CoreTest, DrivesAsIsIntendedAndNumbersItsCommands) {
  const Core::Outputs first = step();
  EXPECT_TRUE(first.output.active);
  EXPECT_GT(first.output.speed, 0.0);
  EXPECT_EQ(step().number, first.number + 1);
  ASSERT_EQ(first.notes.lines().size(), 1U);
  EXPECT_EQ(first.notes.lines()[0], (Note{Note::Level::info, "drives"}));
}

// The earlier intent stands for a place in another frame.
TEST_F(CoreTest, AnIntentOfAnotherOdomFrameDoesNotDrive) {
  step();
  EXPECT_TRUE(step().output.active);
  inputs_.new_frame = true;
  EXPECT_FALSE(step().output.active) << "it is of the cycle before the frame began";
  EXPECT_TRUE(step().output.active);
}

TEST_F(CoreTest, ASuspendedExecutionReleasesTheRobotAndSaysWhy) {
  step();
  core_.processes().find("execute-current-behaviors")->interrupt();
  const Core::Outputs outputs = step();
  EXPECT_FALSE(outputs.output.active);
  EXPECT_TRUE(outputs.output.behaviors.empty());
  EXPECT_EQ(outputs.output.inactive_reason, "execute-current-behaviors is suspended");
  core_.processes().find("execute-current-behaviors")->resume();
  EXPECT_TRUE(step().output.active);
}

TEST_F(CoreTest, CommandsThatComeLateSlowTheRobotDownAndAreTold) {
  const double fast = step().output.speed;
  inputs_.command_age = 1.1;
  const Core::Outputs slow = step();
  EXPECT_LT(slow.output.speed, fast);
  EXPECT_NE(slow.degraded.find("the robot drives more slowly"), std::string::npos);
  ASSERT_FALSE(slow.notes.empty());
  EXPECT_EQ(slow.notes.lines()[0].level, Note::Level::warning);
  EXPECT_TRUE(step().notes.empty()) << "it is told once";
  inputs_.command_age = 0.1;
  bool told = false;
  for (int i = 0; i < 200 && !told; ++i) {
    const Core::Outputs outputs = step();
    for (const Note& note : outputs.notes.lines())
      told = told || note.text == "the network is fast enough again";
  }
  EXPECT_TRUE(told);
  EXPECT_DOUBLE_EQ(step().output.speed, fast);
}

TEST_F(CoreTest, ANewEpochForgetsTheDelayOfTheLastOne) {
  const double fast = step().output.speed;
  inputs_.command_age = 1.1;
  step();
  inputs_.command_age.reset();
  inputs_.cycle = 0;
  EXPECT_DOUBLE_EQ(step().output.speed, fast);
}

TEST_F(CoreTest, WhatCannotBeHadIsToldWhenItChanges) {
  step();
  const auto fly = [&] {
    inputs_.intent = Intent{inputs_.cycle, true, {{"f", "Fly", 2, true, {}}}};
    return step_with_that_intent();
  };
  const Core::Outputs outputs = fly();
  EXPECT_FALSE(outputs.output.active);
  ASSERT_FALSE(outputs.notes.empty());
  EXPECT_NE(outputs.notes.lines()[0].text.find("Fly"), std::string::npos);
  EXPECT_TRUE(fly().notes.empty());
}

}  // namespace
}  // namespace saphira::behaviors
