#include "saphira/sim/corners.hpp"

#include <gtest/gtest.h>

#include "saphira/sim/world.hpp"

namespace saphira::sim {
namespace {

const Corner* at(const std::vector<Corner>& corners, const Vec2& point) {
  for (const Corner& corner : corners)
    if ((corner.point - point).norm() < 0.01)
      return &corner;
  return nullptr;
}

TEST(Corners, TheEndOfAWallIsAnEdgeFromEverywhere) {
  const auto corners = find_corners({{{0.0, 0.0}, {1.0, 0.0}}});
  ASSERT_EQ(corners.size(), 2U);
  for (const Vec2& viewer : {Vec2(2.0, 0.1), Vec2(2.0, -0.1), Vec2(0.5, 3.0), Vec2(1.1, -3.0)})
    EXPECT_EQ(shape_from(*at(corners, {1.0, 0.0}), viewer), CornerShape::kEdge) << viewer;
}

TEST(Corners, AWallInTwoPiecesGoesStraightOn) {
  const auto corners = find_corners({{{0.0, 0.0}, {1.0, 0.0}}, {{1.001, 0.0}, {2.0, 0.001}}});
  EXPECT_EQ(corners.size(), 2U);
  EXPECT_EQ(at(corners, {1.0, 0.0}), nullptr);
}

TEST(Corners, ACornerIsAMirrorFromWithinAndAnEdgeFromWithout) {
  const auto corners = find_corners({{{0.0, 0.0}, {1.0, 0.0}}, {{1.0, 1.0}, {1.0, 0.0}}});
  ASSERT_EQ(corners.size(), 3U);
  const Corner* corner = at(corners, {1.0, 0.0});
  ASSERT_NE(corner, nullptr);
  EXPECT_EQ(corner->arms.size(), 2U);
  EXPECT_EQ(shape_from(*corner, {0.5, 0.5}), CornerShape::kInner);
  EXPECT_DOUBLE_EQ(corner->shortest, 1.0);
  EXPECT_EQ(shape_from(*corner, {1.5, -0.5}), CornerShape::kEdge);
}

// A partition meets the wall from above: below, the wall is smooth.
TEST(Corners, AnAttachedPartitionMakesCornersOnItsOwnSide) {
  const auto corners = find_corners({{{-2.0, 0.0}, {2.0, 0.0}}, {{0.0, 0.0}, {0.0, 1.0}}});
  ASSERT_EQ(corners.size(), 4U);
  const Corner* foot = at(corners, {0.0, 0.0});
  ASSERT_NE(foot, nullptr);
  EXPECT_EQ(foot->arms.size(), 3U);
  EXPECT_EQ(shape_from(*foot, {1.0, 1.0}), CornerShape::kInner);
  EXPECT_EQ(shape_from(*foot, {-1.0, 1.0}), CornerShape::kInner);
  EXPECT_EQ(shape_from(*foot, {1.0, -1.0}), CornerShape::kNone);
  EXPECT_EQ(shape_from(*foot, {-0.1, -1.0}), CornerShape::kNone);
}

// Only a square one reflects sound back to its source.
TEST(Corners, AnAskewInnerCornerIsNoMirror) {
  const auto corners = find_corners({{{0.0, 0.0}, {1.0, 0.0}}, {{0.0, 0.0}, {0.1, 1.0}}});
  ASSERT_NE(at(corners, {0.0, 0.0}), nullptr);
  EXPECT_EQ(shape_from(*at(corners, {0.0, 0.0}), {0.5, 0.5}), CornerShape::kNone);
  EXPECT_EQ(shape_from(*at(corners, {0.0, 0.0}), {-0.5, 0.5}), CornerShape::kEdge);
}

TEST(Corners, WallsUponEachOtherAreOne) {
  const auto corners =
      find_corners({{{0.0, 0.0}, {1.0, 0.0}}, {{0.2, 0.0}, {1.0, 0.0}}, {{1.0, 0.0}, {0.5, 0.0}}});
  const Corner* end = at(corners, {1.0, 0.0});
  ASSERT_NE(end, nullptr);
  EXPECT_EQ(end->arms.size(), 1U);
  EXPECT_EQ(at(corners, {0.2, 0.0}), nullptr);
}

}  // namespace
}  // namespace saphira::sim
