#include <gtest/gtest.h>

#include <algorithm>

#include "saphira/base/random.hpp"
#include "saphira/behaviors/blend.hpp"

// Properties of every blend, tested with many random ones.
namespace saphira::behaviors {
namespace {

constexpr int kTrials = 20'000;

Rule rule(Random& random) {
  constexpr Action kActions[] = {Action::turn_left, Action::turn_right, Action::accelerate,
                                 Action::decelerate, Action::speed};
  Rule out;
  out.action = kActions[random.next() % 5];
  out.strength = random.chance(0.2) ? 0.0 : random.chance(0.2) ? 1.0 : random.uniform(0.0, 1.0);
  out.value = out.action == Action::speed ? random.uniform(-0.5, 0.5) : random.uniform(0.0, 1.0);
  return out;
}

double activity(Random& random) {
  return random.chance(0.2) ? 0.0 : random.chance(0.2) ? 1.0 : random.uniform(0.0, 1.0);
}

std::vector<Blended> behaviors(Random& random) {
  std::vector<Blended> out(1 + random.next() % 8);
  int priority = 0;
  for (Blended& one : out) {
    one.priority = priority;
    priority += static_cast<int>(random.next() % 2);
    for (std::uint32_t i = random.next() % 6; i > 0; --i)
      one.evaluation.rules.push_back(rule(random));
    one.evaluation.activity = {activity(random), activity(random)};
  }
  return out;
}

bool turns(const Rule& r) {
  return r.action == Action::turn_left || r.action == Action::turn_right;
}

/// The recommendation of one rule by itself.
double asked(const Rule& one, double velocity) {
  Blended alone;
  alone.evaluation.rules = {one};
  alone.evaluation.rules[0].strength = 1.0;
  alone.evaluation.activity = {1.0, 1.0};
  std::vector<Blended> set{alone};
  const Blend result = blend(set, velocity);
  return turns(one) ? result.turn : result.speed;
}

TEST(BlendProperty, LiesWithinTheHullOfWhatIsRecommended) {
  Random random(1);
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Blended> set = behaviors(random);
    const double velocity = random.uniform(-0.4, 0.4);
    double turn_low = 0.0;  // "straight on" is always among the recommendations
    double turn_high = 0.0;
    double speed_low = 1e9;
    double speed_high = -1e9;
    for (const Blended& one : set)
      for (const Rule& r : one.evaluation.rules) {
        const double value = asked(r, velocity);
        if (turns(r)) {
          turn_low = std::min(turn_low, value);
          turn_high = std::max(turn_high, value);
        } else if (r.strength > 0.0) {
          speed_low = std::min(speed_low, value);
          speed_high = std::max(speed_high, value);
        }
      }
    const Blend result = blend(set, velocity);
    ASSERT_GE(result.turn, turn_low - 1e-12);
    ASSERT_LE(result.turn, turn_high + 1e-12);
    if (result.moving) {
      ASSERT_GE(result.speed, speed_low - 1e-12);
      ASSERT_LE(result.speed, speed_high + 1e-12);
    }
    for (const Blended& one : set) {
      ASSERT_GE(one.turn_weight, 0.0);
      ASSERT_LE(one.turn_weight, 1.0);
      ASSERT_GE(one.speed_weight, 0.0);
      ASSERT_LE(one.speed_weight, 1.0);
    }
  }
}

TEST(BlendProperty, AFullyActiveHigherPrioritySuppressesTheLowerOnes) {
  Random random(2);
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Blended> set = behaviors(random);
    const double velocity = random.uniform(-0.4, 0.4);
    for (Blended& one : set)
      if (one.priority == 0)
        one.evaluation.activity = {1.0, 1.0};
    std::vector<Blended> alone;
    for (const Blended& one : set)
      if (one.priority == 0)
        alone.push_back(one);
    const Blend both = blend(set, velocity);
    const Blend highest = blend(alone, velocity);
    ASSERT_EQ(both.turning, highest.turning);
    ASSERT_EQ(both.turn, highest.turn);
    ASSERT_EQ(both.moving, highest.moving);
    ASSERT_EQ(both.speed, highest.speed);
    for (const Blended& one : set)
      if (one.priority > 0) {
        ASSERT_EQ(one.turn_weight, 0.0);
        ASSERT_EQ(one.speed_weight, 0.0);
      }
  }
}

TEST(BlendProperty, WhatIsNotActiveDoesNotShow) {
  Random random(3);
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Blended> set = behaviors(random);
    const Blend before = blend(set, 0.2);
    Blended silent;
    silent.priority = static_cast<int>(random.next() % 3);
    silent.evaluation.rules = {rule(random), rule(random)};
    set.insert(std::find_if(set.begin(), set.end(),
                            [&](const Blended& b) { return b.priority > silent.priority; }),
               silent);
    const Blend after = blend(set, 0.2);
    ASSERT_DOUBLE_EQ(before.turn, after.turn);
    ASSERT_DOUBLE_EQ(before.speed, after.speed);
  }
}

}  // namespace
}  // namespace saphira::behaviors
