#include "saphira/authority/age.hpp"

#include <gtest/gtest.h>

#include "saphira/base/age.hpp"

namespace saphira::authority {
namespace {

Guarded wanted(double velocity) {
  return {velocity, 0.5, GuardAction::none, {}};
}

TEST(SlowForAge, AFreshCommandPassesAsItIs) {
  for (const double velocity : {0.0, 0.4, -0.2, 2.0}) {
    const Guarded out = slow_for_age(wanted(velocity), 0.1, 0.1);
    EXPECT_EQ(out.velocity, velocity);
    EXPECT_EQ(out.action, GuardAction::none);
  }
}

TEST(SlowForAge, TheOlderTheSlowerAheadAndBack) {
  double before = 10.0;
  for (double age = 0.3; age < 3.0; age += 0.1) {
    const Guarded out = slow_for_age(wanted(2.0), age, 0.1);
    EXPECT_LT(out.velocity, before);
    EXPECT_NEAR(out.velocity * (age - 0.1), kUnseenWay, 1e-9);
    EXPECT_EQ(out.rotation_velocity, 0.5);
    EXPECT_EQ(slow_for_age(wanted(-2.0), age, 0.1).velocity, -out.velocity);
    before = out.velocity;
  }
  EXPECT_EQ(slow_for_age(wanted(0.4), 4.0, 0.1).velocity, 0.0);
}

TEST(SlowForAge, SaysHowOldTheCommandIs) {
  const Guarded out = slow_for_age(wanted(0.4), 0.6, 0.1);
  EXPECT_EQ(out.action, GuardAction::limit);
  EXPECT_EQ(out.reason, "0.40 m/s cut to 0.30: the command answers what the robot said 0.6 s ago");
}

TEST(SlowForAge, WhatTheGuardSaysStands) {
  Guarded guarded = wanted(0.35);
  guarded.action = GuardAction::slow;
  guarded.reason = "something ahead";
  const Guarded out = slow_for_age(guarded, 0.6, 0.1);
  EXPECT_NEAR(out.velocity, 0.3, 1e-9);
  EXPECT_EQ(out.action, GuardAction::slow);
  EXPECT_EQ(out.reason, "something ahead");
}

}  // namespace
}  // namespace saphira::authority
