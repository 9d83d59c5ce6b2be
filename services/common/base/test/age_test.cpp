#include "saphira/base/age.hpp"

#include <gtest/gtest.h>

namespace saphira {
namespace {

TEST(Age, WhatIsFreshDoesNotLimit) {
  EXPECT_TRUE(std::isinf(speed_for_age(0.0)));
  EXPECT_TRUE(std::isinf(speed_for_age(-0.1)));
}

TEST(Age, WithinTheAgeOfItsInputsTheRobotMovesNoFurtherThanTheStatedWay) {
  double before = std::numeric_limits<double>::infinity();
  for (double age = 0.05; age <= kOldest; age += 0.05) {
    const double speed = speed_for_age(age);
    EXPECT_NEAR(speed * age, kUnseenWay, 1e-12) << age;
    EXPECT_LT(speed, before);
    EXPECT_GE(speed, kCreep - 1e-12);
    before = speed;
  }
  EXPECT_EQ(speed_for_age(kOldest + 0.01), 0.0);
}

TEST(Age, TheSpeedThatStopsNeedsJustTheFreeWay) {
  for (const double deceleration : {0.3, 0.6, 2.0})
    for (const double reaction : {0.0, 0.1, 0.6, 1.0})
      for (const double free : {0.01, 0.3, 1.0, 3.0}) {
        const double v = speed_that_stops(free, reaction, deceleration);
        EXPECT_NEAR(v * reaction + v * v / (2.0 * deceleration), free, 1e-9);
      }
  EXPECT_EQ(speed_that_stops(0.0, 0.1, 1.0), 0.0);
  EXPECT_EQ(speed_that_stops(-1.0, 0.1, 1.0), 0.0);
  // By the published table: 0.6 m, 0.6 m/s2, 0.6 s.
  EXPECT_NEAR(speed_that_stops(0.6, 0.6, 0.6), 0.56, 0.005);
}

TEST(Age, APeakIsHeldAndFades) {
  PeakAge age;
  EXPECT_EQ(age.hear(0.5), 0.5);
  EXPECT_EQ(age.hear(0.7), 0.7);
  double last = 0.7;
  for (int i = 0; i < 15; ++i) {
    const double now = age.hear(0.5);
    EXPECT_LT(now, last);
    last = now;
  }
  // A peak of any size halves in 2.3 s.
  last = age.hear(10.0);
  for (int i = 0; i < 23; ++i)
    age.hear(0.0);
  EXPECT_NEAR(age.peak(), last / 2.0, 0.1);
}

}  // namespace
}  // namespace saphira
