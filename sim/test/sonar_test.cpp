#include "saphira/sim/sonar.hpp"

#include <gtest/gtest.h>

#include <vector>

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
  model.noise = model.relative_noise = model.dropout = 0.0;
  return model;
}

World wall_at(double millimetres) {
  return parse_world("width 9000 height 9000\n" + std::to_string(millimetres) + " -5000 " +
                         std::to_string(millimetres) + " 5000",
                     "wall.wld");
}

TEST(Sonars, RangeIsFromTheTransducer) {
  const World world = wall_at(2000);
  const Scene scene(world);
  Sonars sonars(scene, kNobody, one_sonar(0.13), exact(), 1);
  const auto echo = sonars.fire(0, {0.5, 1.0, 0.0});
  ASSERT_TRUE(echo.range);
  EXPECT_NEAR(*echo.range, 1.37, 1e-9);
}

TEST(Sonars, TheNearestInTheConeCounts) {
  const World world = wall_at(2000);
  const Scene scene(world);
  Sonars sonars(scene, kNobody, one_sonar(), exact(), 1);
  // Turned by 10 degrees, the wall's foot is still within the half cone of 12.5: of nine rays the
  // nearest is less than 1.6 degrees beside it.
  const auto echo = sonars.fire(0, {0.0, 0.0, radians(10.0)});
  ASSERT_TRUE(echo.range);
  EXPECT_NEAR(*echo.range, 2.0, 2.0 * (1.0 / std::cos(radians(1.6)) - 1.0) + 1e-9);
  const auto aside = sonars.fire(0, {0.0, 0.0, radians(25.0)});
  ASSERT_TRUE(aside.range);
  EXPECT_NEAR(*aside.range, 2.0 / std::cos(radians(12.5)), 1e-9);
}

TEST(Sonars, NoEchoBeyondTheRangeOrBehind) {
  const World world = wall_at(6000);
  const Scene scene(world);
  Sonars sonars(scene, kNobody, one_sonar(), exact(), 1);
  EXPECT_FALSE(sonars.fire(0, {0.0, 0.0, 0.0}).range);
  EXPECT_TRUE(sonars.fire(0, {1.5, 0.0, 0.0}).range);
  EXPECT_FALSE(sonars.fire(0, {1.5, 0.0, kPi}).range);
}

// The rays of the cone reach 12.5 degrees to the wall's side of where the sonar points to.
TEST(Sonars, GlancingSurfacesAreLost) {
  const World world = wall_at(1000);
  const Scene scene(world);
  SonarModel model = exact();
  model.specular_loss = 0.9;
  Sonars sonars(scene, kNobody, one_sonar(), model, 1);
  int glancing = 0;
  int steep = 0;
  constexpr int kFirings = 2000;
  for (int i = 0; i < kFirings; ++i) {
    glancing += sonars.fire(0, {0.0, 0.0, radians(28.0)}).range ? 1 : 0;
    steep += sonars.fire(0, {0.0, 0.0, radians(26.0)}).range ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(glancing) / kFirings, 0.1, 0.03);
  EXPECT_EQ(steep, kFirings);
}

// What a sonar hears of a corridor's wall that it looks along is its door posts.
TEST(Sonars, CornersAreHeardWhereTheWallIsNot) {
  // A wall along y = 1 with a door in it, and a partition that meets it from behind at x = 5.
  const World world = parse_world(
      "width 9000 height 9000\n0 1000 2000 1000 2900 1000 9000 1000 5000 1000 5000 2000",
      "door.wld");
  const Scene scene(world);
  SonarModel model = exact();
  model.specular_loss = 1.0;
  model.corner_loss = 0.0;
  Sonars sonars(scene, kNobody, one_sonar(), model, 1);
  const auto post = sonars.fire(0, {1.0, 0.0, radians(45.0)});
  ASSERT_TRUE(post.range);
  EXPECT_NEAR(*post.range, std::sqrt(2.0), 1e-9);
  EXPECT_TRUE(sonars.fire(0, {1.0, 0.0, radians(54.0)}).range);
  EXPECT_FALSE(sonars.fire(0, {1.0, 0.0, radians(56.0)}).range);
  // Towards where the partition is, the wall is smooth, and it hides the partition's end.
  EXPECT_FALSE(sonars.fire(0, {4.0, 0.0, radians(45.0)}).range);
  EXPECT_FALSE(sonars.fire(0, {6.0, 0.0, radians(125.0)}).range);
  model.corner_loss = 1.0;
  Sonars deaf(scene, kNobody, one_sonar(), model, 1);
  EXPECT_FALSE(deaf.fire(0, {1.0, 0.0, radians(45.0)}).range);
}

TEST(Sonars, NoiseAndDropouts) {
  const World world = wall_at(2000);
  SonarModel model;
  model.dropout = 0.1;
  const Scene scene(world);
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
  EXPECT_NEAR(std::sqrt(squares / heard), 0.003 + 0.003 * 2.0, 0.0003);
}

TEST(Sonars, FireByThePollingSequenceEvery40Milliseconds) {
  const World world = wall_at(2000);
  RobotParameters parameters;
  for (std::uint8_t i = 0; i < 7; ++i)
    parameters.sonars.push_back({i, {}});
  const Scene scene(world);
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
  const Scene scene(world);
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

}  // namespace
}  // namespace saphira::sim
