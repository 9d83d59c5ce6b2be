// A stand-in of the Player family of clients (the p2os driver, and ROS' of the same descent).

#include <gtest/gtest.h>

#include "player_client.hpp"

namespace saphira::test {
namespace {

class Player : public ::testing::TestWithParam<std::string> {};

TEST_P(Player, ConnectsDrivesSeesAndStops) {
  Line line(GetParam());
  PlayerClient client(line);
  ASSERT_EQ(client.connect(), "");
  EXPECT_FALSE(client.warned);
  ASSERT_TRUE(client.switch_on());
  const KnownRobot& known = *client.known();
  ASSERT_TRUE(client.ranges.contains(known.front));
  EXPECT_NEAR(client.ranges.at(known.front), 3000.0 - known.front_x, 150.0);

  ASSERT_TRUE(client.drive_a_metre());
  EXPECT_EQ(client.tainted, 0);
  EXPECT_NEAR(client.x / 1000.0, line.robot().pose_in_world().x - line.start().x, 0.06);
  EXPECT_GT(client.x, 950.0);
  EXPECT_FALSE(line.robot().moving());
  client.close();
  EXPECT_FALSE(line.server().is_open());
  EXPECT_EQ(line.server().counters().unknown_commands, 0U);
  EXPECT_EQ(line.violations(), "");
}

INSTANTIATE_TEST_SUITE_P(Robots, Player,
                         ::testing::Values("psos43m", "pionat", "p2dx", "p2at", "p2d8+", "p3dx",
                                           "p3dx-sh", "p3at", "p3at-sh", "amigo", "amigo-sh",
                                           "perfpb", "peoplebot-sh", "powerbot-sh", "patrolbot-sh"),
                         [](const auto& robot) { return test_name(robot.param); });

// Without pulses the robot's watchdog stops it after two seconds, and the next command revives it.
TEST(PlayerAgain, SilenceStopsTheRobot) {
  Line line("p3dx-sh");
  PlayerClient client(line);
  ASSERT_EQ(client.connect(), "");
  client.motors(true);
  client.set_speed(150, 0);
  for (int i = 0; i < 19; ++i)
    client.cycle();
  EXPECT_TRUE(line.robot().moving());
  for (int i = 0; i < 20; ++i)
    client.cycle();
  EXPECT_FALSE(line.robot().moving());
  client.set_speed(150, 0);
  for (int i = 0; i < 10; ++i)
    client.cycle();
  EXPECT_NEAR(line.robot().velocity(), 0.15, 1e-6);
}

// A robot without a subclass is not in its table: it warns and takes another entry.
TEST(PlayerAgain, AForeignClassIsWarnedOf) {
  Line line("b21");
  PlayerClient client(line);
  ASSERT_EQ(client.connect(), "");
  EXPECT_TRUE(client.warned);
  EXPECT_TRUE(client.cycle());
}

}  // namespace
}  // namespace saphira::test
