#include "saphira/base/random.hpp"

#include <gtest/gtest.h>

namespace saphira {
namespace {

// The reference output of pcg32 with seed 42 and stream 54 (pcg-random.org, pcg32-demo).
TEST(Random, IsPcg32) {
  Random random(42, 54);
  EXPECT_EQ(random.next(), 0xa15c02b7U);
  EXPECT_EQ(random.next(), 0x7b47f409U);
  EXPECT_EQ(random.next(), 0xba1d3330U);
}

TEST(Random, NormalHasMeanAndDeviation) {
  Random random(1);
  double sum = 0;
  double squares = 0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal(2.0, 3.0);
    sum += x;
    squares += x * x;
  }
  const double mean = sum / kCount;
  EXPECT_NEAR(mean, 2.0, 0.05);
  EXPECT_NEAR(std::sqrt(squares / kCount - mean * mean), 3.0, 0.05);
}

TEST(Random, UniformStaysInRange) {
  Random random(7);
  for (int i = 0; i < 10000; ++i) {
    const double x = random.uniform(-1.0, 2.0);
    ASSERT_GE(x, -1.0);
    ASSERT_LT(x, 2.0);
  }
}

}  // namespace
}  // namespace saphira
