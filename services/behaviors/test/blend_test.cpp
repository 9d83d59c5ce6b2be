#include "saphira/behaviors/blend.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "saphira/base/random.hpp"

namespace saphira::behaviors {
namespace {

Blended behavior(int priority, double activity, std::vector<Rule> rules) {
  Blended b;
  b.priority = priority;
  b.evaluation = {std::move(rules), {.turn = activity, .speed = activity}};
  return b;
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

/// Any behaviors, any activities: the result lies among the recommendations (for turns, with
/// "straight on" among them), and a fully active behavior leaves nothing to those below.
TEST(Blend, StaysWithinTheRecommendations) {
  Random random(17);
  for (int trial = 0; trial < 20000; ++trial) {
    std::vector<Blended> b;
    const int n = 1 + static_cast<int>(random.uniform(0, 6));
    for (int i = 0; i < n; ++i) {
      Evaluation e;
      const int rules = static_cast<int>(random.uniform(0, 5));
      for (int r = 0; r < rules; ++r) {
        const Action actions[] = {Action::turn_left, Action::turn_right, Action::speed};
        e.rules.push_back({"r", random.chance(0.2) ? 0.0 : random.uniform(),
                           actions[static_cast<int>(random.uniform(0, 3))], random.uniform(0, 2)});
      }
      const auto activity = [&] { return random.chance(0.2) ? 1.0 : random.uniform(); };
      e.activity = {.turn = activity(), .speed = activity()};
      Blended one;
      one.priority = static_cast<int>(random.uniform(0, 4));
      one.evaluation = e;
      b.push_back(one);
    }
    std::stable_sort(b.begin(), b.end(),
                     [](const Blended& x, const Blended& y) { return x.priority < y.priority; });
    const Blend result = blend(b, 0.0);
    double turn_low = 0.0;
    double turn_high = 0.0;
    double speed_low = 1e9;
    double speed_high = -1e9;
    bool full = false;
    int full_priority = 0;
    for (const Blended& one : b) {
      if (full && one.priority > full_priority) {
        EXPECT_EQ(one.turn_weight, 0.0);
      }
      if (!full && one.evaluation.activity.turn == 1.0) {
        full = true;
        full_priority = one.priority;
      }
      for (const Rule& rule : one.evaluation.rules) {
        if (rule.action == Action::turn_left)
          turn_high = std::max(turn_high, rule.value);
        if (rule.action == Action::turn_right)
          turn_low = std::min(turn_low, -rule.value);
        if (rule.action == Action::speed && rule.strength > 0.0 && one.speed_weight > 0.0) {
          speed_low = std::min(speed_low, rule.value);
          speed_high = std::max(speed_high, rule.value);
        }
      }
    }
    EXPECT_GE(result.turn, turn_low - 1e-12);
    EXPECT_LE(result.turn, turn_high + 1e-12);
    if (result.moving) {
      EXPECT_GE(result.speed, speed_low - 1e-12);
      EXPECT_LE(result.speed, speed_high + 1e-12);
    }
  }
}

}  // namespace
}  // namespace saphira::behaviors
