#include "saphira/sim/sonar.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "world_scene.hpp"

namespace saphira::sim {
namespace {

using protocol::RobotParameters;

RobotParameters one_sonar(double x = 0.0, double th = 0.0) {
  RobotParameters parameters;
  parameters.sonars.push_back({0, {x, 0.0, radians(th)}});
  return parameters;
}

SonarModel exact() {
  SonarModel model;
  model.noise = model.relative_noise = model.dropout = model.roughness = model.crosstalk =
      model.spread = model.soft_spread = 0.0;
  return model;
}

World wall_at(double millimetres) {
  return parse_world("width 9000 height 9000\n" + std::to_string(millimetres) + " -5000 " +
                         std::to_string(millimetres) + " 5000",
                     "wall.wld");
}

TEST(Sonars, RangeIsFromTheTransducer) {
  WorldScene scene(wall_at(2000));
  Sonars sonars(scene, kNobody, one_sonar(0.13), exact(), 1);
  const auto echo = sonars.fire(0, {0.5, 1.0, 0.0});
  ASSERT_TRUE(echo.range);
  EXPECT_NEAR(*echo.range, 1.37, 1e-9);
}

TEST(Sonars, WhatIsNearerThanTheirLeastRangeReadsAsThat) {
  WorldScene scene(wall_at(2000));
  RobotParameters parameters = one_sonar();
  EXPECT_NEAR(*Sonars(scene, kNobody, parameters, exact(), 1).fire(0, {1.98, 0.0, 0.0}).range, 0.05,
              1e-9);
  parameters.sonar_min_range = 0.005;
  EXPECT_NEAR(*Sonars(scene, kNobody, parameters, exact(), 1).fire(0, {1.98, 0.0, 0.0}).range, 0.02,
              1e-9);
}

TEST(Sonars, AWallAnswersFromWhereItIsMetAtARightAngle) {
  WorldScene scene(wall_at(2000));
  Sonars sonars(scene, kNobody, one_sonar(), exact(), 1);
  for (const double off : {0.0, 10.0, -14.0}) {
    const auto echo = sonars.fire(0, {0.0, 0.0, radians(off)});
    ASSERT_TRUE(echo.range) << off;
    EXPECT_NEAR(*echo.range, 2.0, 1e-9) << off;
  }
}

TEST(Sonars, TheNearestCounts) {
  WorldScene scene(parse_world(
      "width 9000 height 9000\n2000 -1000 2000 1000  3000 -4000 3000 4000  500 2000 700 2000",
      "w"));
  Sonars sonars(scene, kNobody, one_sonar(), exact(), 1);
  EXPECT_NEAR(*sonars.fire(0, {0.0, 0.0, 0.0}).range, 2.0, 1e-9);
  // The far wall is met behind the near one's end; the end itself is 14 degrees aside.
  EXPECT_NEAR(*sonars.fire(0, {0.0, 1.5, radians(0.0)}).range, 3.0, 1e-9);
}

TEST(Sonars, NoEchoBeyondTheRangeOrBehind) {
  WorldScene scene(wall_at(6000));
  Sonars sonars(scene, kNobody, one_sonar(), exact(), 1);
  EXPECT_FALSE(sonars.fire(0, {0.0, 0.0, 0.0}).range);
  EXPECT_TRUE(sonars.fire(0, {1.5, 0.0, 0.0}).range);
  EXPECT_FALSE(sonars.fire(0, {1.5, 0.0, kPi}).range);
}

// Beyond 17 degrees a wall is heard less and less, and at a larger distance even less.
TEST(Sonars, GlancingSurfacesAreLost) {
  const auto share = [](double distance_mm, double off) {
    WorldScene scene(wall_at(distance_mm));
    Sonars sonars(scene, kNobody, one_sonar(), exact(), 1);
    constexpr int kFirings = 4000;
    int heard = 0;
    for (int i = 0; i < kFirings; ++i)
      heard += sonars.fire(0, {0.0, 0.0, radians(off)}).range ? 1 : 0;
    return static_cast<double>(heard) / kFirings;
  };
  EXPECT_EQ(share(500, 16.9), 1.0);
  EXPECT_NEAR(share(500, 30.0), 1.0 - 13.0 / 55.5, 0.03);  // of 17 to 95 - 45 * 0.5 degrees
  EXPECT_EQ(share(500, 73.0), 0.0);
  EXPECT_NEAR(share(1500, 20.0), 1.0 - 3.0 / 10.5, 0.03);
  EXPECT_EQ(share(1500, 28.0), 0.0);
  EXPECT_EQ(share(4000, 16.9), 1.0);
  EXPECT_EQ(share(4000, 17.1), 0.0);
}

TEST(Sonars, RoughSurfacesAnswerAtAnyAngle) {
  WorldScene scene(wall_at(1000));
  SonarModel model = exact();
  model.roughness = 1.0;
  Sonars sonars(scene, kNobody, one_sonar(), model, 1);
  const auto echo = sonars.fire(0, {0.0, 0.0, radians(70.0)});
  ASSERT_TRUE(echo.range);
  EXPECT_NEAR(*echo.range, 1.0 / std::cos(radians(57.5)), 1e-9);
}

// A sonar along a corridor's wall hears its door posts.
TEST(Sonars, CornersAreHeardWhereTheWallIsNot) {
  // A wall along y = 1 with a door in it, and a partition that meets it from behind at x = 5.
  WorldScene scene(parse_world(
      "width 9000 height 9000\n0 1000 2000 1000 2900 1000 9000 1000 5000 1000 5000 2000",
      "door.wld"));
  SonarModel model = exact();
  model.lost_angle = model.critical_angle;
  Sonars sonars(scene, kNobody, one_sonar(), model, 1);
  const auto post = sonars.fire(0, {1.0, 0.0, radians(45.0)});
  ASSERT_TRUE(post.range);
  EXPECT_NEAR(*post.range, std::sqrt(2.0), 0.002);  // weak, so a little late
  EXPECT_TRUE(sonars.fire(0, {1.0, 0.0, radians(54.0)}).range);
  EXPECT_FALSE(sonars.fire(0, {1.0, 0.0, radians(56.0)}).range);
  // Towards the partition the wall is smooth, and it hides the partition's end.
  EXPECT_FALSE(sonars.fire(0, {4.0, 0.0, radians(45.0)}).range);
  EXPECT_FALSE(sonars.fire(0, {6.0, 0.0, radians(125.0)}).range);
  model.strength = 0.0;
  Sonars deaf(scene, kNobody, one_sonar(), model, 1);
  EXPECT_FALSE(deaf.fire(0, {1.0, 0.0, radians(45.0)}).range);
}

TEST(Sonars, NoiseAndDropouts) {
  const World world = wall_at(2000);
  SonarModel model;
  model.dropout = 0.1;
  Scene scene(world);
  Sonars sonars(scene, kNobody, one_sonar(), model, 1);
  constexpr int kFirings = 20000;
  int heard = 0;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kFirings; ++i) {
    const auto echo = sonars.fire(0, {});
    if (!echo.range)
      continue;
    ++heard;
    sum += *echo.range - 2.0;
    squares += (*echo.range - 2.0) * (*echo.range - 2.0);
  }
  EXPECT_NEAR(static_cast<double>(heard) / kFirings, 0.9, 0.01);
  EXPECT_NEAR(sum / heard, 0.0, 0.0005);
  EXPECT_NEAR(std::sqrt(squares / heard), model.noise + 2.0 * model.relative_noise, 0.0003);
}

TEST(Sonars, FireByThePollingSequenceEvery40Milliseconds) {
  const World world = wall_at(2000);
  RobotParameters parameters;
  for (std::uint8_t i = 0; i < 7; ++i)
    parameters.sonars.push_back({i, {}});
  Scene scene(world);
  Sonars sonars(scene, kNobody, parameters, exact(), 1);
  const auto fired = [&](int ticks) {
    std::vector<int> numbers;
    for (int i = 0; i < ticks; ++i)
      if (const auto echo = sonars.tick({}))
        numbers.push_back(echo->number);
    return numbers;
  };
  EXPECT_EQ(fired(32), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 0}));
  sonars.set_polling({0, 1, 0, 5, 99});  // manual 5.6; there is no 99
  EXPECT_EQ(fired(20), (std::vector<int>{0, 1, 0, 5, 0}));
  sonars.set_polling({});
  EXPECT_TRUE(fired(100).empty());
  EXPECT_EQ(fired(1000).size(), 0U);
  sonars.set_default_polling();
  EXPECT_EQ(fired(1000).size(), 250U);  // 25 a second
}

// A Pioneer 2 fires two arrays of eight at the same time: 50 readings a second.
TEST(Sonars, ArraysTakeTurns) {
  const World world = wall_at(2000);
  RobotParameters parameters;
  for (std::uint8_t i = 0; i < 16; ++i)
    parameters.sonars.push_back({i, {}});
  parameters.sonar_arrays = 2;
  Scene scene(world);
  Sonars sonars(scene, kNobody, parameters, exact(), 1);
  std::vector<int> numbers;
  for (int i = 0; i < 100; ++i)
    if (const auto echo = sonars.tick({}))
      numbers.push_back(echo->number);
  ASSERT_EQ(numbers.size(), 50U);
  EXPECT_EQ(std::vector<int>(numbers.begin(), numbers.begin() + 6),
            (std::vector<int>{0, 8, 1, 9, 2, 10}));
  EXPECT_EQ(default_polling(7, 1), (std::vector<std::uint8_t>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(default_polling(24, 3).size(), 24U);
  parameters.sonar_max_range = 1.0;
  Sonars near_sighted(scene, kNobody, parameters, exact(), 1);
  EXPECT_FALSE(near_sighted.fire(0, {}).range);
}

// The sonar before has heard a near object, and this one hears it instead of the wall.
TEST(Sonars, TheLastFiringsEchoIsHeardNowAndThen) {
  WorldScene scene(parse_world("width 9000 height 9000 2000 -5000 2000 5000 -5000 -1000 1000 -1000",
                               "wall.wld"));
  RobotParameters parameters = one_sonar();
  parameters.sonars.push_back({1, {0.0, 0.0, radians(-90.0)}});
  parameters.sonar_arrays = 2;
  SonarModel model = exact();
  model.crosstalk = 0.1;
  Sonars sonars(scene, kNobody, parameters, model, 1);
  int near = 0;
  constexpr int kFirings = 5000;
  for (int i = 0; i < kFirings; ++i) {
    EXPECT_NEAR(*sonars.fire(1, {}).range, 1.0, 1e-9);  // never farther
    near += *sonars.fire(0, {}).range < 1.5 ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(near) / kFirings, 0.1, 0.02);
}

}  // namespace
}  // namespace saphira::sim
