#include "saphira/vision/core.hpp"

#include <gtest/gtest.h>

#include "saphira/base/archive.hpp"

namespace saphira::vision {
namespace {

/// A standing robot with a camera whose channel A shows an object each cycle.
class CoreTest : public testing::Test {
 protected:
  CoreTest() { inputs_.odom = 1; }

  static Core::Seen seen(std::uint64_t cycle, std::uint64_t odom = 1) {
    Core::Seen one{.cycle = cycle, .odom = odom};
    one.channels[0] = {80, 60, 400, 20, 20};
    return one;
  }
  Core::Outputs step() {
    ++inputs_.cycle;
    inputs_.new_robot = inputs_.cycle == 1;
    core_.processes().step(inputs_.cycle);
    Core::Outputs outputs = core_.step(inputs_);
    inputs_.new_frame = false;
    inputs_.seen.clear();
    return outputs;
  }
  void drive(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      if (inputs_.cycle > 0)
        inputs_.seen = {seen(inputs_.cycle)};
      step();
    }
  }

  Core core_;
  Core::Inputs inputs_;
};

TEST_F(CoreTest, SeesColorsWhileChannelsCome) {
  EXPECT_FALSE(step().sees_colors);
  drive(5);
  EXPECT_TRUE(step().sees_colors);
  EXPECT_FALSE(step().things.empty());
  for (int i = 0; i < 30; ++i)
    step();
  EXPECT_FALSE(step().sees_colors);
}

// A step sees the samples before it, whenever they came.
TEST_F(CoreTest, ChannelsOfTheCycleAreLeftToTheNextStep) {
  step();
  inputs_.seen = {seen(2)};
  EXPECT_FALSE(step().sees_colors);
  EXPECT_TRUE(step().sees_colors);
}

TEST_F(CoreTest, ChannelsOfAnotherFrameAreNotPlaced) {
  step();
  inputs_.seen = {seen(1, 7)};
  EXPECT_FALSE(step().sees_colors);
}

TEST_F(CoreTest, ASuspendedTaskSeesNothing) {
  step();
  core_.processes().find("find-colors")->interrupt();
  drive(3);
  EXPECT_FALSE(step().sees_colors);
}

// The robot's state gives the number of the second before: lockstep waits for that many.
TEST_F(CoreTest, KnowsWhetherAllChannelsOfASecondHaveCome) {
  EXPECT_TRUE(core_.has_channels(1, 0, {}));
  step();
  EXPECT_FALSE(core_.has_channels(2, 1, {}));
  EXPECT_TRUE(core_.has_channels(2, 1, {seen(1)}));
  EXPECT_FALSE(core_.has_channels(2, 2, {seen(1), seen(2)})) << "one is of the cycle itself";
  EXPECT_TRUE(core_.has_channels(2, 2, {seen(1), seen(1)})) << "a camera that is twice as fast";
  drive(20);
  EXPECT_FALSE(core_.has_channels(22, 10, {}));
  EXPECT_TRUE(core_.has_channels(22, 9, {})) << "it was silent for a cycle";
  EXPECT_TRUE(core_.has_channels(22, 10, {seen(21)}));
}

TEST_F(CoreTest, WhoJoinsLateWaitsForNothingThatItCannotCount) {
  inputs_.cycle = 50;
  inputs_.new_robot = true;
  core_.processes().step(50);
  core_.step(inputs_);
  inputs_.cycle = 50;
  EXPECT_TRUE(core_.has_channels(51, 10, {}));
}

TEST_F(CoreTest, SaysWhyNoPicturesCome) {
  inputs_.no_pictures = "/tmp/eyes: not connected yet";
  const Core::Outputs outputs = step();
  ASSERT_EQ(outputs.notes.lines().size(), 1U);
  EXPECT_EQ(outputs.notes.lines()[0].text, "no stereo pictures: /tmp/eyes: not connected yet");
  EXPECT_TRUE(step().notes.empty());
  inputs_.no_pictures.clear();
  EXPECT_EQ(step().notes.lines()[0].text, "stereo pictures come");
}

TEST(Core, ARestoredOneGoesOnAsTheOldOneToTheLastBit) {
  std::optional<Core> core(std::in_place);
  std::optional<Core> restored(std::in_place);
  Core::Inputs inputs;
  inputs.new_robot = true;
  inputs.odom = 1;
  for (inputs.cycle = 1; inputs.cycle <= 300; ++inputs.cycle) {
    const auto at = static_cast<double>(inputs.cycle);
    inputs.pose_in_odom = {0.03 * at, 0.01 * at, 0.002 * at};
    inputs.seen.clear();
    if (inputs.cycle % 70 > 10) {  // else out of sight
      Core::Seen seen{inputs.cycle - 1, 1, inputs.pose_in_odom, {}};
      seen.channels[0] = {80 - static_cast<int>(inputs.cycle % 90), -10, 400, 20, 20};
      seen.channels[2] = {-30, 20, 90, 10, 10};
      inputs.seen = {seen};
    }
    if (inputs.cycle % 50 == 0) {
      const std::string state = saved(*restored);
      EXPECT_EQ(state, saved(*core));
      saphira::restore(state, restored.emplace());
    }
    core->processes().step(inputs.cycle);
    restored->processes().step(inputs.cycle);
    const Core::Outputs outputs = core->step(inputs);
    EXPECT_FALSE(outputs.things.empty() && inputs.cycle % 70 > 20);
    EXPECT_EQ(outputs.things, restored->step(inputs).things);
    inputs.new_robot = false;
  }
}

}  // namespace
}  // namespace saphira::vision
