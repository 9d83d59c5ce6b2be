#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "saphira/base/random.hpp"
#include "saphira/geometry/axes.hpp"
#include "saphira/geometry/clip.hpp"
#include "saphira/geometry/cone.hpp"
#include "saphira/geometry/edge.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira {
namespace {

TEST(PrincipalAxes, AreThoseOfATurnedEllipse) {
  const double angle = 0.7;
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Matrix2d covariance =
      4.0 * along * along.transpose() + 1e-4 * across * across.transpose();
  const auto axes = principal_axes(covariance);
  EXPECT_NEAR(axes.eigenvalues()[0], 1e-4, 1e-12);
  EXPECT_NEAR(axes.eigenvalues()[1], 4.0, 1e-12);
  EXPECT_NEAR(std::abs(axes.eigenvectors().col(0).dot(across)), 1.0, 1e-12);
  EXPECT_NEAR(std::abs(axes.eigenvectors().col(1).dot(along)), 1.0, 1e-12);
}

TEST(PrincipalAxes, OfACircleAndOfNothingAreSomeRightAngle) {
  for (const double size : {1.0, 0.0}) {
    const auto axes = principal_axes(size * Eigen::Matrix2d::Identity());
    EXPECT_DOUBLE_EQ(axes.eigenvalues()[0], size);
    EXPECT_DOUBLE_EQ(axes.eigenvalues()[1], size);
    EXPECT_NEAR(axes.eigenvectors().determinant() * axes.eigenvectors().determinant(), 1.0, 1e-12);
  }
}

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

/// The rule of the grids.
bool inside(const Pose& tip, double edge, double range, double dx, double dy) {
  const double along = std::cos(tip.th) * dx + std::sin(tip.th) * dy;
  const double across = -std::sin(tip.th) * dx + std::cos(tip.th) * dy;
  return along > 0.0 && std::abs(across) <= edge * along && std::hypot(dx, dy) <= range;
}

TEST(ConeRows, LeavesOutNothingOfTheCone) {
  Random random(5);
  for (int i = 0; i < 200'000; ++i) {
    // Headings along the rows and columns, and along the cone's edges, as often as any other.
    const double edge = std::tan(radians(random.uniform(2.0, 30.0)));
    double th = random.uniform(-kPi, kPi);
    if (i % 4 == 0)
      th = kPi / 2.0 * std::floor(random.uniform(0.0, 4.0));
    if (i % 4 == 1)
      th = std::atan(edge) * (i % 8 < 4 ? 1.0 : -1.0);
    const Pose tip{0.0, 0.0, th};
    const double range = random.uniform(0.1, 5.0);
    const double dx = random.uniform(-range, range);
    const double dy = i % 16 == 3 ? 0.0 : random.uniform(-range, range);
    if (!inside(tip, edge, range, dx, dy))
      continue;
    const ConeRows cone(tip, edge, range);
    const auto [low, high] = cone.span(dy);
    EXPECT_GE(dx, low - 1e-6);
    EXPECT_LE(dx, high + 1e-6);
    EXPECT_GE(dx, cone.columns().first - 1e-6);
    EXPECT_LE(dx, cone.columns().second + 1e-6);
    EXPECT_GE(dy, cone.rows().first - 1e-6);
    EXPECT_LE(dy, cone.rows().second + 1e-6);
  }
}

TEST(ConeRows, IsNarrow) {
  const Pose ahead{0.0, 0.0, 0.0};
  const auto [low, high] = ConeRows(ahead, std::tan(radians(12.5)), 2.0).span(0.1);
  EXPECT_NEAR(low, 0.1 / std::tan(radians(12.5)), 1e-9);
  EXPECT_NEAR(high, std::sqrt(4.0 - 0.01), 1e-9);
  const auto [from, to] = ConeRows(ahead, std::tan(radians(12.5)), 2.0).span(1.0);
  EXPECT_GT(from, to);
  const ConeRows left({0.0, 0.0, kPi / 2.0}, std::tan(radians(12.5)), 2.0);
  EXPECT_NEAR(left.columns().first, -2.0 * std::sin(radians(12.5)), 1e-9);
  EXPECT_NEAR(left.columns().second, 2.0 * std::sin(radians(12.5)), 1e-9);
  EXPECT_EQ(left.rows(), std::pair(0.0, 2.0));
}

const double kSlope = std::tan(radians(15.0));

TEST(Edge, IsAsFarAsItsNearestPointInTheCone) {
  EXPECT_DOUBLE_EQ(*distance_in_cone({{1.0, -2.0}, {1.0, 2.0}}, kSlope), 1.0) << "a wall across";
  // A wall along the left side meets the cone's edge first.
  EXPECT_NEAR(*distance_in_cone({{-3.0, 0.5}, {5.0, 0.5}}, kSlope), 0.5 / std::sin(radians(15.0)),
              1e-9);
  EXPECT_DOUBLE_EQ(*distance_in_cone({{2.0, 0.1}, {3.0, 0.1}}, kSlope), std::hypot(2.0, 0.1));
  EXPECT_EQ(distance_in_cone({{3.0, 0.1}, {2.0, 0.1}}, kSlope),
            distance_in_cone({{2.0, 0.1}, {3.0, 0.1}}, kSlope));
}

TEST(Edge, OutsideTheConeHasNoDistance) {
  EXPECT_FALSE(distance_in_cone({{-1.0, -2.0}, {-1.0, 2.0}}, kSlope)) << "behind";
  EXPECT_FALSE(distance_in_cone({{0.5, 1.0}, {0.5, 2.0}}, kSlope)) << "beside";
  EXPECT_FALSE(distance_in_cone({{-2.0, 1.0}, {1.0, 1.0}}, kSlope)) << "it ends before the cone";
}

TEST(Edge, MayBeAPost) {
  EXPECT_DOUBLE_EQ(*distance_in_cone({{1.0, 0.2}, {1.0, 0.2}}, kSlope), std::hypot(1.0, 0.2));
  EXPECT_FALSE(distance_in_cone({{1.0, 0.3}, {1.0, 0.3}}, kSlope));
}

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
