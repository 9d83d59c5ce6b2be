#include "saphira/lps/obstacle_memory.hpp"

#include <gtest/gtest.h>

namespace saphira::lps {
namespace {

TEST(ObstacleMemory, KeepsWhatLeavesTheSonarsSight) {
  ObstacleMemory memory;
  memory.echo({0.0, 0.0, 0.0}, 1.0, 1);
  memory.update({0.8, -0.3, 0.0}, 40);
  ASSERT_EQ(memory.points().size(), 1U);
  EXPECT_NEAR(memory.points()[0].x(), 0.2, 1e-12);
  EXPECT_NEAR(memory.points()[0].y(), 0.3, 1e-12);
}

TEST(ObstacleMemory, ForgetsWhatIsOldOrFar) {
  ObstacleMemory memory;
  memory.echo({0.0, 0.0, 0.0}, 1.0, 1);
  memory.update({}, 101);
  EXPECT_EQ(memory.points().size(), 1U);
  memory.update({}, 102);
  EXPECT_TRUE(memory.points().empty());
  memory.echo({0.0, 0.0, 0.0}, 1.0, 103);
  memory.update({4.5, 0.0, 0.0}, 104);
  EXPECT_TRUE(memory.points().empty());
}

TEST(ObstacleMemory, AnEchoFromBehindDisproves) {
  ObstacleMemory memory;
  memory.echo({0.0, 0.0, 0.0}, 1.0, 1);
  memory.echo({0.0, 0.0, 0.0}, 2.0, 2);
  memory.update({}, 2);
  EXPECT_EQ(memory.points().size(), 2U);  // once may be a mistake
  memory.echo({0.0, 0.0, 0.0}, 2.0, 3);
  memory.update({}, 3);
  ASSERT_EQ(memory.points().size(), 1U);
  EXPECT_NEAR(memory.points()[0].x(), 2.0, 1e-12);
}

TEST(ObstacleMemory, SilenceDisprovesMoreSlowly) {
  ObstacleMemory memory;
  memory.echo({0.0, 0.0, 0.0}, 1.0, 1);
  for (int i = 0; i < 2; ++i)
    memory.silence({0.0, 0.0, 0.0}, 2.5);
  memory.update({}, 2);
  EXPECT_EQ(memory.points().size(), 1U);
  memory.silence({0.0, 0.0, 0.0}, 2.5);
  memory.update({}, 3);
  EXPECT_TRUE(memory.points().empty());
}

TEST(ObstacleMemory, BeamsBesideItSayNothing) {
  ObstacleMemory memory;
  memory.echo({0.0, 0.0, 0.0}, 1.0, 1);
  for (int i = 0; i < 9; ++i)
    memory.silence({0.0, 0.0, radians(15)}, 2.5);
  memory.update({}, 2);
  EXPECT_EQ(memory.points().size(), 1U);
}

TEST(ObstacleMemory, IsBounded) {
  MemorySettings settings;
  settings.capacity = 5;
  ObstacleMemory memory(settings);
  for (int i = 0; i < 20; ++i)
    memory.echo({0.0, 0.0, radians(18.0 * i)}, 1.0, static_cast<std::uint64_t>(i));
  memory.update({}, 20);
  EXPECT_EQ(memory.points().size(), 5U);
}

}  // namespace
}  // namespace saphira::lps
