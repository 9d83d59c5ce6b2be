#include "saphira/sim/sonar.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "world_scene.hpp"

namespace saphira::sim {
namespace {

using protocol::RobotParameters;

World wall_at(double millimetres) {
  return parse_world("width 9000 height 9000\n" + std::to_string(millimetres) + " -5000 " +
                         std::to_string(millimetres) + " 5000",
                     "wall.wld");
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

TEST(Sonars, NoiseAndDropouts) {
  const World world = wall_at(2000);
  SonarModel model{.dropout = 0.1};
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
