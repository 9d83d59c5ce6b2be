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

TEST(Bands, ShowAPersonAtThreeHeights) {
  WorldScene scene(
      world("person ann 8000 5000 0 0 0 19000 20000 0 20000 20000 12000 0 12000 20000"));
  scene.add_robot({}, {5.0, 5.0, 0.0}, 1);
  StereoCamera camera;
  camera.noise = camera.dropout = 0.0;
  Random random(1);
  const auto bands = see_bands(scene, 0, camera, random);
  int person = 0;
  for (const RangeBand& band : bands) {
    ASSERT_EQ(band.size(), 80U);
    ASSERT_TRUE(band[40]);
    EXPECT_NEAR(*band[40], 2.75, 0.06);  // a step of disparity is b d / (b/r)^2
    ASSERT_TRUE(band[5]);
    EXPECT_NEAR(*band[5], 7.0, 0.4);  // the wall
    for (const auto& range : band)
      person += range && *range < 3.5 ? 1 : 0;
  }
  // 0.5 m at 3 m, of 80 columns over 2 tan 30: in three bands.
  EXPECT_NEAR(person, 3.0 * 80.0 * (0.5 / 2.96) / (2.0 * std::tan(radians(30.0))), 6.0);
}

TEST(Bands, LowThingsAreBelowThemAndMatchesFail) {
  WorldScene scene(world("post bin 7000 5000 300 tall 900 10000 0 10000 20000"));
  scene.add_robot({}, {5.0, 5.0, 0.0}, 1);
  StereoCamera camera;
  camera.dropout = 0.2;
  Random random(1);
  int none = 0;
  double squares = 0.0;
  int count = 0;
  for (int i = 0; i < 100; ++i)
    for (const RangeBand& band : see_bands(scene, 0, camera, random))
      for (const auto& range : band) {
        none += range ? 0 : 1;
        if (range) {
          EXPECT_GT(*range, 4.0);
          squares += (*range - 5.0) * (*range - 5.0);
          ++count;
        }
      }
  EXPECT_NEAR(none / (100.0 * 240.0), 0.2, 0.02);
  // Noise of a quarter step, and the rounding to steps of r^2 d / b.
  const double step = 25.0 * camera.disparity / camera.baseline;
  EXPECT_NEAR(std::sqrt(squares / count), step * std::hypot(0.25, std::sqrt(1.0 / 12.0)),
              0.5 * step);
}

}  // namespace
}  // namespace saphira::sim
