#include "saphira/geometry/cone.hpp"

#include <gtest/gtest.h>

#include "saphira/base/random.hpp"

namespace saphira {
namespace {

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

}  // namespace
}  // namespace saphira
