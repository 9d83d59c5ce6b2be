#include "saphira/sim/vision.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "world_scene.hpp"

namespace saphira::sim {
namespace {

World world(const std::string& things) {
  return parse_world("width 20000 height 20000 " + things, "vision.wld");
}

// The camera stands at (5, 5) and looks along x.
std::optional<Blob> see(const World& it, const std::string& color, double th = 0.0) {
  Scene scene(it);
  const Pose robot{5.0 - 0.15 * std::cos(th), 5.0 - 0.15 * std::sin(th), th};
  scene.add_robot({}, robot, 1);
  return see_blob(scene, 0, Camera{}, color);
}

TEST(Blobs, AreWhereTheThingsAre) {
  // 200 mm wide and 700 mm high, its middle at the camera's height, 2 m away.
  const World it = world("post can 7000 5000 100 color red tall 700");
  const auto ahead = see(it, "red");
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(ahead->x, 0, 1);
  EXPECT_NEAR(ahead->width, 2.0 * degrees(std::asin(0.05)) * 3.0, 2.0);
  EXPECT_NEAR(ahead->height, 2.0 * degrees(std::atan2(0.35, 1.95)) * 3.0, 2.0);
  EXPECT_NEAR(ahead->y, 0, 1);
  EXPECT_NEAR(ahead->area, ahead->width * ahead->height, 0.1 * ahead->area);
  EXPECT_FALSE(see(it, "green"));
  // To the right of a robot that has turned left, and out of the picture.
  const auto aside = see(it, "red", radians(10.0));
  ASSERT_TRUE(aside);
  EXPECT_NEAR(aside->x, 30, 1);
  EXPECT_FALSE(see(it, "red", radians(40.0)));
  // A ball on the floor is below the middle.
  EXPECT_LT(see(world("post ball 7000 5000 100 color red tall 200"), "red")->y, -20 / 2);
}

TEST(Blobs, AreHiddenByWhatIsNearerAndAsHigh) {
  const std::string can = "post can 7000 5000 100 color red tall 700 ";
  const int whole = see(world(can), "red")->area;
  EXPECT_FALSE(see(world(can + "6000 4000 6000 6000"), "red"));  // a wall
  const auto half = see(world(can + "6000 5000 6000 6000"), "red");
  ASSERT_TRUE(half);
  EXPECT_NEAR(half->area, whole / 2, whole / 10);
  EXPECT_GT(half->x, 0);
  // A low box hides the foot.
  const auto top = see(world(can + "box b 6000 5000 0 200 800 5 tall 200"), "red");
  ASSERT_TRUE(top);
  EXPECT_LT(top->area, whole);
  EXPECT_GT(top->y, 0);
}

TEST(Blobs, TheLargestCounts) {
  const World it = world(
      "post small 7000 5500 50 color red tall 700 post large 7000 4500 150 color red tall 700");
  const auto blob = see(it, "red");
  ASSERT_TRUE(blob);
  EXPECT_NEAR(blob->x, degrees(std::atan2(0.5, 2.0)) * 3.0, 2.0);
}

}  // namespace
}  // namespace saphira::sim
