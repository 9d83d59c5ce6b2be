#include "saphira/geometry/clip.hpp"

#include <gtest/gtest.h>

namespace saphira {
namespace {

TEST(Clip, TheStretchOfALineInARectangle) {
  const Vec2 half(2.0, 1.0);
  const auto ray = clip({-5.0, 0.5}, {1.0, 0.0}, half);
  ASSERT_TRUE(ray);
  EXPECT_DOUBLE_EQ(ray->from, 3.0);
  EXPECT_DOUBLE_EQ(ray->to, 7.0);
  EXPECT_FALSE(clip({-5.0, 1.5}, {1.0, 0.0}, half)) << "beside it";
  EXPECT_FALSE(clip({5.0, 0.0}, {1.0, 0.0}, half)) << "behind the line";
  // From its middle to a corner and on.
  const auto segment = clip({0.0, 0.0}, {4.0, 2.0}, half, {0.0, 1.0});
  ASSERT_TRUE(segment);
  EXPECT_DOUBLE_EQ(segment->from, 0.0);
  EXPECT_DOUBLE_EQ(segment->to, 0.5);
  EXPECT_FALSE(clip({-5.0, 0.0}, {2.0, 0.0}, half, {0.0, 1.0})) << "it ends before the rectangle";
}

}  // namespace
}  // namespace saphira
