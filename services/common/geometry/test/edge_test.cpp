#include "saphira/geometry/edge.hpp"

#include <gtest/gtest.h>

namespace saphira {
namespace {

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

}  // namespace
}  // namespace saphira
