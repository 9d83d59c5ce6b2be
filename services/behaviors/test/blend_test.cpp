#include "saphira/behaviors/blend.hpp"

#include <gtest/gtest.h>

namespace saphira::behaviors {
namespace {

Blended behavior(int priority, double activity, std::vector<Rule> rules) {
  return Blended{.priority = priority,
                 .evaluation = {std::move(rules), {.turn = activity, .speed = activity}}};
}

TEST(Blend, NobodyHasASay) {
  std::vector<Blended> none;
  const Blend b = blend(none, 0.3);
  EXPECT_FALSE(b.turning);
  EXPECT_FALSE(b.moving);
  EXPECT_EQ(b.speed, 0.0);
}

TEST(Blend, FullActivitySuppressesLowerPriorities) {
  std::vector<Blended> b{
      behavior(0, 1.0, {{"r", 1.0, Action::turn_left, 0.4}, {"s", 1.0, Action::speed, 0.0}}),
      behavior(1, 1.0, {{"r", 1.0, Action::turn_right, 0.9}, {"s", 1.0, Action::speed, 0.4}})};
  const Blend result = blend(b, 0.0);
  EXPECT_EQ(result.turn, 0.4);
  EXPECT_EQ(result.speed, 0.0);
  EXPECT_EQ(b[1].turn_weight, 0.0);
  EXPECT_EQ(b[1].speed_weight, 0.0);
  // Its recommendation is still reported.
  EXPECT_EQ(b[1].turn, -0.9);
  EXPECT_EQ(b[1].speed, 0.4);
}

TEST(Blend, LeftOverGoesToLowerPriorities) {
  std::vector<Blended> b{behavior(0, 0.25, {{"s", 1.0, Action::speed, 0.0}}),
                         behavior(1, 1.0, {{"s", 1.0, Action::speed, 0.4}})};
  EXPECT_NEAR(blend(b, 0.0).speed, 0.3, 1e-12);
  EXPECT_NEAR(b[1].speed_weight, 0.75, 1e-12);
}

TEST(Blend, ChannelsAreIndependent) {
  Blended avoid = behavior(0, 0.0, {{"s", 1.0, Action::speed, 0.1}});
  avoid.evaluation.activity.speed = 1.0;
  std::vector<Blended> b{
      avoid,
      behavior(1, 1.0, {{"r", 1.0, Action::turn_left, 0.2}, {"s", 1.0, Action::speed, 0.4}})};
  const Blend result = blend(b, 0.0);
  EXPECT_EQ(result.turn, 0.2);
  EXPECT_EQ(result.speed, 0.1);
}

TEST(Blend, EqualPrioritiesAreEqual) {
  std::vector<Blended> b{behavior(2, 1.0, {{"s", 1.0, Action::speed, 0.2}}),
                         behavior(2, 0.5, {{"s", 1.0, Action::speed, 0.5}})};
  EXPECT_NEAR(blend(b, 0.0).speed, 0.3, 1e-12);
}

TEST(Blend, WeakTurnsAreSmallTurns) {
  // The missing weight is "straight on".
  std::vector<Blended> b{behavior(0, 1.0, {{"r", 0.25, Action::turn_left, 0.4}})};
  EXPECT_NEAR(blend(b, 0.0).turn, 0.1, 1e-12);
}

TEST(Blend, AcceleratesFromThePresentVelocity) {
  std::vector<Blended> b{behavior(0, 1.0, {{"a", 1.0, Action::accelerate, 0.1}})};
  EXPECT_NEAR(blend(b, 0.2).speed, 0.3, 1e-12);
  b = {behavior(0, 1.0, {{"d", 1.0, Action::decelerate, 0.5}})};
  EXPECT_EQ(blend(b, 0.2).speed, 0.0);  // to a stop, not into reverse
}

}  // namespace
}  // namespace saphira::behaviors
