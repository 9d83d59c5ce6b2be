#include "saphira/lps/point.hpp"

#include <gtest/gtest.h>

namespace saphira::lps {
namespace {

TEST(Point, OfTheRobot) {
  const Pose p{3.0, -3.0, kPi / 2};
  EXPECT_NEAR(phi(p), -kPi / 4, 1e-12);
  EXPECT_NEAR(distance(p), 3.0 * std::sqrt(2.0), 1e-12);
  // The line through p runs along y at x = 3.
  EXPECT_NEAR(normal_distance(p), 3.0, 1e-12);
  // The robot is 3 m further along the line's direction, and 3 m to its left.
  EXPECT_NEAR(xo(p), 3.0, 1e-12);
  EXPECT_NEAR(yo(p), 3.0, 1e-12);
}

TEST(Point, OfEachOther) {
  const Pose p{1.0, 1.0, kPi};
  const Pose q{4.0, 5.0, 0.0};
  EXPECT_NEAR(distance(p, q), 5.0, 1e-12);
  EXPECT_NEAR(xo(p, q), -3.0, 1e-12);
  EXPECT_NEAR(yo(p, q), -4.0, 1e-12);
  EXPECT_NEAR(normal_distance(p, q), 4.0, 1e-12);
}

TEST(Point, BaricenterIsMidwayInPlaceAndDirection) {
  const Pose middle = baricenter({0.0, 0.0, radians(170)}, {2.0, 4.0, radians(-170)});
  EXPECT_NEAR(middle.x, 1.0, 1e-12);
  EXPECT_NEAR(middle.y, 2.0, 1e-12);
  EXPECT_NEAR(std::abs(middle.th), kPi, 1e-9);
}

TEST(Point, ViewpointsAreInverse) {
  const Pose p{1.0, -2.0, 0.7};
  const Pose q{-0.5, 3.0, -2.9};
  const Pose back = unchange_vp(p, change_vp(p, q));
  EXPECT_NEAR(back.x, q.x, 1e-12);
  EXPECT_NEAR(back.y, q.y, 1e-12);
  EXPECT_NEAR(back.th, q.th, 1e-12);
}

TEST(Point, MovesInItsOwnSystem) {
  const Pose moved = move({1.0, 1.0, kPi / 2}, 2.0, 0.5);
  EXPECT_NEAR(moved.x, 0.5, 1e-12);
  EXPECT_NEAR(moved.y, 3.0, 1e-12);
  EXPECT_NEAR(moved.th, kPi / 2, 1e-12);
}

}  // namespace
}  // namespace saphira::lps
