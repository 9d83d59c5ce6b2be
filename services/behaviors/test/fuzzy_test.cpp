#include "saphira/behaviors/fuzzy.hpp"

#include <gtest/gtest.h>

namespace saphira::behaviors {
namespace {

TEST(Fuzzy, StraightUp) {
  EXPECT_EQ(straight_up(0.0, 1.0, 3.0), 0.0);
  EXPECT_EQ(straight_up(1.0, 1.0, 3.0), 0.0);
  EXPECT_EQ(straight_up(1.5, 1.0, 3.0), 0.25);
  EXPECT_EQ(straight_up(3.0, 1.0, 3.0), 1.0);
  EXPECT_EQ(straight_up(2.0, 2.0, 2.0), 1.0);
}

TEST(Fuzzy, DownStraight) {
  EXPECT_EQ(down_straight(0.0, 1.0, 3.0), 1.0);
  EXPECT_EQ(down_straight(1.5, 1.0, 3.0), 0.75);
  EXPECT_EQ(down_straight(4.0, 1.0, 3.0), 0.0);
}

TEST(Fuzzy, Comparisons) {
  EXPECT_EQ(f_greater(2.0, 2.0, 1.0), 0.5);
  EXPECT_EQ(f_greater(2.5, 2.0, 1.0), 1.0);
  EXPECT_EQ(f_greater(1.5, 2.0, 1.0), 0.0);
  EXPECT_EQ(f_smaller(1.5, 2.0, 1.0), 1.0);
  EXPECT_EQ(f_smaller(2.25, 2.0, 1.0), 0.25);
  EXPECT_EQ(f_eq(2.0, 2.0, 1.0), 1.0);
  EXPECT_EQ(f_eq(1.5, 2.0, 1.0), 0.5);
  EXPECT_EQ(f_eq(3.0, 2.0, 1.0), 0.0);
}

TEST(Fuzzy, Combinations) {
  EXPECT_EQ(f_and(0.3, 0.7), 0.3);
  EXPECT_EQ(f_and(0.3, 0.7, 0.1), 0.1);
  EXPECT_EQ(f_or(0.3, 0.7), 0.7);
  EXPECT_NEAR(f_not(0.3), 0.7, 1e-12);
}

}  // namespace
}  // namespace saphira::behaviors
