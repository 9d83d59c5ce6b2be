#include "saphira/lps/occupancy.hpp"

#include <gtest/gtest.h>

namespace saphira::lps {
namespace {

// Only the two worked examples describe manual Figure 6-2: a reading left of the robot at Y = 300
// mm and one right of it at X = 600 mm, each the nearest in its rectangle.
const std::vector<Vec2> kFigure62{{1.2, 0.3}, {0.9, 0.7}, {0.6, -0.5}, {1.3, -0.4}, {0.3, 0.1}};

TEST(OccupancyBox, WorkedExamplesOfTheManual) {
  const Occupancy left = occupancy_box(kFigure62, Axis::sides, 1.0, 0.6, 0.9, 0.8);
  EXPECT_NEAR(left.distance, 0.3, 1e-12);
  EXPECT_EQ(left.point, Vec2(1.2, 0.3));
  const Occupancy right = occupancy_box(kFigure62, Axis::front, 1.0, -0.6, 0.9, 0.6);
  EXPECT_NEAR(right.distance, 0.6, 1e-12);
  EXPECT_EQ(right.point, Vec2(0.6, -0.5));
}

TEST(OccupancyBox, IsPositiveOnTheRightToo) {
  const Occupancy found = occupancy_box({{1.0, -0.7}}, Axis::sides, 1.0, -0.6, 0.9, 0.6);
  EXPECT_NEAR(found.distance, 0.7, 1e-12);
}

TEST(OccupancyBox, HeightRunsAlongX) {
  // Inside 0.9 high, 0.2 wide; outside if the two were exchanged.
  EXPECT_TRUE(occupancy_box({{1.4, 0.0}}, Axis::front, 1.0, 0.0, 0.9, 0.2).point);
  EXPECT_FALSE(occupancy_box({{1.0, 0.4}}, Axis::front, 1.0, 0.0, 0.9, 0.2).point);
}

TEST(OccupancyBox, NothingIsFiveMetres) {
  const Occupancy nothing = occupancy_box(kFigure62, Axis::front, -3.0, 0.0, 1.0, 1.0);
  EXPECT_EQ(nothing.distance, 5.0);
  EXPECT_FALSE(nothing.point);
  // A farther reading gives the same result as none.
  EXPECT_FALSE(occupancy_box({{6.0, 0.0}}, Axis::front, 6.0, 0.0, 1.0, 1.0).point);
}

TEST(OccupancyPlane, WorkedExampleOfTheManual) {
  // sfOccPlane(sfFRONT, sfFRONT, 600, 400, 1200) is 650: nearer ones lie before the baseline or
  // outside the sides, Y = 400 and Y = -1200.
  const std::vector<Vec2> points{{0.65, -1.1}, {0.7, 0.3}, {0.62, 0.5}, {0.61, -1.3}, {0.5, 0.0}};
  const Occupancy found = occupancy_plane(points, Direction::front, 0.6, 0.4, 1.2);
  EXPECT_NEAR(found.distance, 0.65, 1e-12);
  EXPECT_EQ(found.point, Vec2(0.65, -1.1));
}

TEST(OccupancyPlane, LooksToEverySide) {
  const std::vector<Vec2> points{{-0.8, 0.1}, {0.2, 0.9}, {-0.3, -1.0}};
  EXPECT_NEAR(occupancy_plane(points, Direction::back, 0.5, 0.5, 0.5).distance, 0.8, 1e-12);
  EXPECT_NEAR(occupancy_plane(points, Direction::left, 0.5, 0.5, 0.5).distance, 0.9, 1e-12);
  EXPECT_NEAR(occupancy_plane(points, Direction::right, 0.5, 0.5, 0.5).distance, 1.0, 1e-12);
  // s1 bounds the side ahead: with 0.1 the left one is out.
  EXPECT_FALSE(occupancy_plane(points, Direction::left, 0.5, 0.1, 0.5).point);
  EXPECT_EQ(occupancy_plane(points, Direction::front, 0.5, 0.5, 0.5).distance, 5.0);
}

}  // namespace
}  // namespace saphira::lps
