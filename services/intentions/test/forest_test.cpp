#include "saphira/intentions/forest.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <utility>

#include "saphira/intentions/beliefs.hpp"

namespace saphira::intentions {
namespace {

class Scripted : public Activity {
 public:
  explicit Scripted(std::function<void(Self&)> body) : body_(std::move(body)) {}
  void step(Self& self) override { body_(self); }

 private:
  std::function<void(Self&)> body_;
};

std::unique_ptr<Activity> act(std::function<void(Self&)> body) {
  return std::make_unique<Scripted>(std::move(body));
}

const Robot kRobot{.connected = true};

TEST(Forest, StepsThroughTheStatesOfTheManual) {
  Forest forest;
  std::vector<IntentionState> seen;
  const auto id = forest.plant({1, 1}, "it", "test", act([&](Self& self) {
                                 seen.push_back(self.state());
                                 self.say("at work");
                               }));
  forest.step(1, kRobot);
  forest.step(2, kRobot);
  forest.interrupt(id);
  forest.step(3, kRobot);
  forest.step(4, kRobot);  // suspended: not stepped
  EXPECT_EQ(forest.nodes().at(0).state, IntentionState::kSuspended);
  forest.resume(id);
  forest.step(5, kRobot);
  EXPECT_EQ(seen, (std::vector{IntentionState::kInit, IntentionState::kRunning,
                               IntentionState::kInterrupted, IntentionState::kResumed}));
  EXPECT_EQ(forest.foremost(id).step, "at work");
}

TEST(Forest, WhatIsNotInterruptedIsNotResumed) {
  Forest forest;
  std::vector<IntentionState> seen;
  const auto id =
      forest.plant({1, 1}, "it", "test", act([&](Self& self) { seen.push_back(self.state()); }));
  forest.step(1, kRobot);
  forest.resume(id);
  forest.step(2, kRobot);
  EXPECT_EQ(seen, (std::vector{IntentionState::kInit, IntentionState::kRunning}));
}

TEST(Forest, AFirstStepOutOfTurnIsNoSecondOne) {
  Forest forest;
  int steps = 0;
  const auto act_once = [&](Self&) { ++steps; };
  const Surroundings nothing;
  const Beliefs beliefs;
  const World world{kRobot, nothing, beliefs, 1};
  const auto id = forest.plant({1, 1}, "it", "test", act(act_once));
  forest.step(world);
  forest.begin(id, world);
  EXPECT_EQ(steps, 1);
  forest.begin(forest.plant({1, 2}, "it", "test", act(act_once)), world);
  EXPECT_EQ(steps, 2);
  // Interruption and resumption within a cycle must leave no gap in the intent.
  forest.interrupt(id);
  forest.resume(id);
  forest.begin(id, world);
  EXPECT_EQ(steps, 3);
}

TEST(Forest, AnInterruptedIntentionLeavesNothingRunning) {
  Forest forest;
  const auto id = forest.plant(
      {1, 1}, "it", "test", act([&](Self& self) {
        self.intend_behavior("Stop", "Stop", 3, {});
        if (self.state() == IntentionState::kInit)
          self.intend("child", "test",
                      act([](Self& child) { child.intend_behavior("A", "A", 0, {}); }), 0, true);
      }));
  forest.step(1, kRobot);
  forest.step(2, kRobot);
  EXPECT_EQ(forest.behaviors().size(), 2U);
  EXPECT_EQ(forest.nodes().size(), 4U);
  forest.interrupt(id);
  forest.step(3, kRobot);
  EXPECT_TRUE(forest.behaviors().empty());
  EXPECT_EQ(forest.nodes().size(), 1U);
}

TEST(Forest, ARootThatFinishesGoesWithAllItsOwn) {
  Forest forest;
  const auto id = forest.plant({1, 1}, "it", "test", act([&](Self& self) {
                                 self.intend_behavior("Stop", "Stop", 3, {});
                                 if (self.now() == 2)
                                   self.fail(v1::CODE_BLOCKED, "no way");
                               }));
  forest.step(1, kRobot);
  EXPECT_TRUE(forest.contains(id));
  forest.step(2, kRobot);
  EXPECT_FALSE(forest.contains(id));
  EXPECT_TRUE(forest.nodes().empty());
  const auto ended = forest.take_ended();
  EXPECT_EQ(ended.at(id).state, IntentionState::kFailure);
  EXPECT_EQ(ended.at(id).code, v1::CODE_BLOCKED);
  EXPECT_EQ(ended.at(id).reason, "no way");
  EXPECT_TRUE(forest.take_ended().empty());
}

TEST(Forest, AFinishedChildStaysForItsParentToRead) {
  Forest forest;
  std::uint32_t child = 0;
  std::vector<IntentionState> seen;
  forest.plant({1, 1}, "it", "test", act([&](Self& self) {
                 if (child == 0)
                   child = self.intend("child", "test",
                                       act([](Self& each) { each.succeed("done"); }), 0, true);
                 seen.push_back(self.child_state(child));
                 if (self.now() == 3)
                   self.remove_child(child);
               }));
  for (Ticks now = 1; now <= 4; ++now)
    forest.step(now, kRobot);
  EXPECT_EQ(seen, (std::vector{IntentionState::kInit, IntentionState::kInit,
                               IntentionState::kSuccess, IntentionState::kRemoved}));
}

TEST(Forest, AChildTimesOut) {
  Forest forest;
  std::uint32_t child = 0;
  forest.plant({1, 1}, "it", "test", act([&](Self& self) {
                 if (child == 0)
                   child = self.intend(
                       "child", "test",
                       act([](Self& each) { each.intend_behavior("A", "A", 0, {}); }), 5, true);
                 if (self.child_state(child) == IntentionState::kTimeout)
                   self.succeed("it timed out");
               }));
  Ticks now = 1;
  while (forest.take_ended().empty() && now < 20)
    forest.step(now++, kRobot);
  EXPECT_EQ(now - 1, 7);  // begun in 1, over in 6, seen by its parent in 7
}

TEST(Forest, ABehaviorIsOneInstanceHoweverOftenItIsIntended) {
  Forest forest;
  double speed = 0.1;
  const auto id =
      forest.plant({1, 1}, "it", "test", act([&](Self& self) {
                     self.intend_behavior("Go", "ConstantVelocity", 2, {number("speed", speed)});
                   }));
  forest.step(1, kRobot);
  const IntendedBehavior first = forest.behaviors().at(0);
  speed = 0.2;
  forest.step(2, kRobot);
  ASSERT_EQ(forest.behaviors().size(), 1U);
  const IntendedBehavior second = forest.behaviors().at(0);
  EXPECT_EQ(second.name, first.name);
  EXPECT_EQ(find(second.parameters, "speed")->number, 0.2);
  EXPECT_EQ(second.intention, forest.nodes().at(1).id);
  EXPECT_EQ(forest.nodes().at(1).parent, id);
}

TEST(Forest, ALevelCountsOnlyForTheParametersThatItIsOf) {
  Forest forest;
  double x = 1.0;
  double level = -1.0;
  forest.plant({1, 1}, "it", "test", act([&](Self& self) {
                 self.intend_behavior("Go", "GoToPos", 2, {point("goal", {x, 0, 0})});
                 level = self.level("Go");
               }));
  forest.step(1, kRobot);
  const std::string name = forest.behaviors().at(0).name;
  forest.hear({{name, 0.7, 0.0}}, 1);  // may be for the earlier parameters
  forest.step(3, kRobot);
  EXPECT_EQ(level, 0.0);
  forest.hear({{name, 0.7, 0.0}, {"another", 1.0, 0.0}}, 2);
  forest.step(4, kRobot);
  EXPECT_EQ(level, 0.7);
  x = 2.0;
  forest.step(5, kRobot);
  forest.hear({{name, 0.7, 0.0}}, 4);
  forest.step(6, kRobot);
  EXPECT_EQ(level, 0.0);
}

}  // namespace
}  // namespace saphira::intentions
