#include "saphira/geometry/pose.hpp"

#include <gtest/gtest.h>

namespace saphira {
namespace {

TEST(Angle, NormalizationsOfTheManual) {
  EXPECT_NEAR(norm_angle(-kPi / 2), 1.5 * kPi, 1e-12);
  EXPECT_NEAR(norm_angle(5 * kPi), kPi, 1e-12);
  EXPECT_NEAR(norm2_angle(1.5 * kPi), -kPi / 2, 1e-12);
  EXPECT_NEAR(norm2_angle(-kPi), kPi, 1e-12);
  EXPECT_NEAR(degrees(norm3_angle(radians(100))), 80, 1e-9);
  EXPECT_NEAR(degrees(norm3_angle(radians(-100))), -80, 1e-9);
  EXPECT_NEAR(degrees(norm3_angle(radians(30))), 30, 1e-9);
  EXPECT_LT(norm_angle(-1e-20), 2 * kPi);
}

TEST(Pose, ComposeAndRelativeAreInverse) {
  const Pose frame{1.0, -2.0, 2.5};
  const Pose inside{0.3, 4.0, -3.0};
  const Pose back = relative(frame, compose(frame, inside));
  EXPECT_NEAR(back.x, inside.x, 1e-12);
  EXPECT_NEAR(back.y, inside.y, 1e-12);
  EXPECT_NEAR(back.th, inside.th, 1e-12);
  const Vec2 point = transform(frame, inside.position());
  EXPECT_NEAR(point.x(), compose(frame, inside).x, 1e-12);
  EXPECT_NEAR(to_frame(frame, point).x(), inside.x, 1e-12);
  EXPECT_NEAR(to_frame(frame, point).y(), inside.y, 1e-12);
}

}  // namespace
}  // namespace saphira
