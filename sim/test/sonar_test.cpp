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
  const auto aside = sonars.fire(0, {0.0, 0.0, radians(40.0)});
  ASSERT_TRUE(aside.range);
  EXPECT_NEAR(*aside.range, 2.0 / std::cos(radians(27.5)), 1e-9);
}

TEST(Sonars, NoEchoBeyondTheRangeOrBehind) {
  const World world = wall_at(6000);
  const Scene scene(world);
  Sonars sonars(scene, kNobody, one_sonar(), exact(), 1);
  EXPECT_FALSE(sonars.fire(0, {0.0, 0.0, 0.0}).range);
  EXPECT_TRUE(sonars.fire(0, {1.5, 0.0, 0.0}).range);
  EXPECT_FALSE(sonars.fire(0, {1.5, 0.0, kPi}).range);
}

TEST(Sonars, GlancingSurfacesAreLostAtTimes) {
  const World world = wall_at(1000);
  const Scene scene(world);
  Sonars sonars(scene, kNobody, one_sonar(), exact(), 1);
  int glancing = 0;
  int steep = 0;
  constexpr int kFirings = 2000;
  for (int i = 0; i < kFirings; ++i) {
    // The cone's nearest ray meets the wall at 12.5 degrees less.
    glancing += sonars.fire(0, {0.0, 0.0, radians(75.0)}).range ? 1 : 0;
    steep += sonars.fire(0, {0.0, 0.0, radians(70.0)}).range ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(glancing) / kFirings, 0.7, 0.05);
  EXPECT_EQ(steep, kFirings);
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

}  // namespace
}  // namespace saphira::sim
